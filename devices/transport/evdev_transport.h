#pragma once
// Input devices of the kernel (/dev/input/event*): listing by what they can do, and opening one for this program alone.
// Real devices only.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/transport/transport.h"

namespace dubsar {

/// One input device as /sys tells it; nothing has been opened.
struct EvdevNode {
  std::string path;  ///< "/dev/input/event3"
  std::string name;  ///< printable ASCII
  std::uint16_t vendor_id = 0, product_id = 0;
  bool touch_panel = false;  ///< what is touched is what is seen, and it tells places of several contacts
  bool slots = false;        ///< its contacts are told apart (multi-touch type B)
};

/// All input devices of this machine, ordered by their number. Takes some milliseconds; needs no permissions. Any
/// thread.
std::vector<EvdevNode> list_evdev_nodes();

/// Opens one node and holds it for this program (EVIOCGRAB), so that no other hears of it until the transport goes.
/// While fingers are on the glass it is not held yet, or others would never hear of their release, and reads give
/// nothing. kUnavailable: not there, or held by another program; kPermission, with the udev rule that mends it; kIo.
///
/// read() gives whole events (devices/touch/evdev_event.h) on the monotonic clock; get_feature() gives an axis in the
/// form that stands there; write() is kUsage. `id` is what enumeration said.
Result<std::unique_ptr<Transport>> open_evdev(const std::string& path, UsbId id = {});

}  // namespace dubsar
