#pragma once
// HID devices through hidapi (hidraw): listing and opening. Real devices only.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

/// One HID interface as the kernel tells it; nothing has been opened.
struct HidNode {
  std::string path;  ///< "/dev/hidraw3"
  std::uint16_t vendor_id = 0, product_id = 0;
  std::uint16_t usage_page = 0, usage = 0;
  int interface_number = -1;
  std::string manufacturer, product, serial;  ///< printable ASCII
  bool operator==(const HidNode&) const = default;
};

/// All HID interfaces of this machine, ordered by path. Takes some milliseconds; needs no permissions. Any thread.
std::vector<HidNode> list_hid_nodes();

/// Opens one node for reading and writing. kUnavailable: not there; kPermission: not allowed, with the udev rule that
/// mends it; kIo: busy or refused by the kernel. The transport is lost when the node disappears: a read that finds
/// nothing for 250 ms looks whether the node is still the one that was opened, because hidraw may stay silent for ever.
/// `id` is what enumeration said; the transport tells it to the protocol.
Result<std::unique_ptr<Transport>> open_hid(const std::string& path, const Clock& clock, UsbId id = {});

}  // namespace dubsar
