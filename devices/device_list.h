#pragma once
// Which devices are here, by the table of drivers, and why those that cannot be used cannot.

#include <memory>
#include <string>
#include <vector>

#include "devices/device_info.h"
#include "devices/drivers.h"
#include "devices/transport/evdev_transport.h"
#include "devices/transport/hid_listing.h"
#include "devices/transport/transport.h"

namespace dubsar {
struct UsbDevice;

/// What HID interfaces are to us; those that no driver knows are left out. `permission`: 0, or the errno that opening
/// it for reading and writing would give.
std::vector<DeviceInfo> known_hid_devices(const std::vector<HidNode>& nodes, int (*permission)(const std::string& path),
                                          DriverTable drivers = driver_table());

/// What USB devices are to us: cameras and those of services; of HID only those that are left alone, with what they
/// need (the others are told by their interfaces).
std::vector<DeviceInfo> known_usb_devices(const std::vector<UsbDevice>& present, DriverTable drivers = driver_table());

/// All HID devices that a driver knows, on this machine. Opens none. Any thread.
std::vector<DeviceInfo> list_hid_devices(DriverTable drivers = driver_table());

/// Opens the first usable device of a driver, whichever node it has now. kUnavailable or kPermission: says what is here
/// and why it cannot be used.
Result<std::unique_ptr<Transport>> open_hid_device(const DriverEntry& driver, const Clock& clock);
/// The same by its name in the program's table.
Result<std::unique_ptr<Transport>> open_hid_device(std::string_view driver, const Clock& clock);

/// What input devices are to us: touch panels. `permission`: 0, or the errno that opening it for reading would give.
std::vector<DeviceInfo> known_touch_panels(const std::vector<EvdevNode>& nodes,
                                           int (*permission)(const std::string& path),
                                           DriverTable drivers = driver_table());

/// Opens the first usable touch panel, or the one at `path` when it is not empty, for this program alone. kUnavailable
/// or kPermission: says what is here and why it cannot be used.
Result<std::unique_ptr<Transport>> open_touch_panel(const DriverEntry& driver, const std::string& path);

/// A daemon's socket, when it is there.
std::vector<DeviceInfo> list_socket(const DriverEntry& driver, const std::string& path);

/// All devices here that a driver knows, with the reason for those that cannot be used: HID, USB, touch panels,
/// cameras, and spacenavd at `spacenav_socket` (empty: the usual path). Opens none; takes some milliseconds. Any
/// thread.
std::vector<DeviceInfo> list_devices(const std::string& spacenav_socket = {}, DriverTable drivers = driver_table());

/// Drivers that a session without --input takes when these devices are here, in the order of the table.
std::vector<const DriverEntry*> taken_unasked(const std::vector<DeviceInfo>& present,
                                              DriverTable drivers = driver_table());

}  // namespace dubsar
