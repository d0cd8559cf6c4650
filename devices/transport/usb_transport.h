#pragma once
// USB devices that are not HID, through libusb: control requests and one bulk or interrupt endpoint to the host.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/transport/transport.h"

namespace dubsar {

struct UsbDevice {
  std::uint16_t vendor_id = 0, product_id = 0;
  int bus = 0, address = 0;
  std::string path;         ///< "usb:001/004": what open_usb_transport takes
  std::string node;         ///< "/dev/bus/usb/001/004": who may open it decides
  bool accessible = false;  ///< this user may read and write the node
};

/// All USB devices, in the order of bus and address. Opens none. kUnavailable when libusb cannot start.
Result<std::vector<UsbDevice>> list_usb_devices();

struct UsbOpenOptions {
  std::vector<int> interfaces{0};      ///< claimed; a kernel driver is detached, and attached again on closing
  std::uint8_t read_endpoint = 0;      ///< to the host, bulk; 0: control requests only
  std::size_t transfer_bytes = 16384;  ///< of one bulk transfer; read() returns one transfer
  bool camera = false;  ///< interfaces and read_endpoint are those of the device's first camera, from its descriptors
  int transfers_in_flight = 8;  ///< so that no data is lost between two reads
};

/// The first device with these ids, or the one at `path` when it is not empty. kNoInput: none is there. kPermission,
/// kUnavailable (busy): says what to do. One thread at a time; write() is kUsage. Reading starts with the first read().
Result<std::unique_ptr<Transport>> open_usb_transport(std::uint16_t vendor_id, std::uint16_t product_id,
                                                      const UsbOpenOptions& options, const std::string& path = {});

/// The line for /etc/udev/rules.d/70-dubsar.rules that lets the user at the screen open the device.
std::string usb_udev_rule(std::uint16_t vendor_id, std::uint16_t product_id);

}  // namespace dubsar
