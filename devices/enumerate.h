#pragma once
// Which devices are here, and why those that cannot be used cannot.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/device_info.h"
#include "devices/transport/hid_transport.h"

namespace dubsar {

/// What a HID interface is to us: the driver's name, or nothing for devices that no driver knows.
/// `permission`: 0, or the errno that opening it for reading and writing would give.
std::vector<DeviceInfo> known_hid_devices(const std::vector<HidNode>& nodes,
                                          int (*permission)(const std::string& path));

/// Glasses among USB devices that no driver reads, with what they need; nothing for others.
std::optional<DeviceInfo> unreadable_glasses(UsbId id, const std::string& path);

/// All HID devices that a driver knows, on this machine. Opens none. Any thread.
std::vector<DeviceInfo> list_hid_devices();

/// Opens the first usable device of a driver, whichever node it has now. kUnavailable or kPermission: says what is here
/// and why it cannot be used.
Result<std::unique_ptr<Transport>> open_hid_device(std::string_view driver, const Clock& clock);

/// The spacenavd daemon's socket, when it is there. It holds its SpaceMouse, which then should be used through it.
std::vector<DeviceInfo> list_spacenavd(const std::string& socket_path);

}  // namespace dubsar
