#pragma once
// What enumeration says about one device: which driver knows it, whether it can be used, and if not, why and what to
// do.

#include <cstdint>
#include <string>
#include <string_view>

namespace dubsar {

enum class DeviceState {
  kUsable,
  kNoPermission,  ///< the node is there, this user may not open it
  kBusy,          ///< another program holds it (cameras)
  kIgnored,       ///< known and deliberately left alone (a vendor's ordinary mouse, say)
  kBroken,        ///< answers, but not as its kind should
};

constexpr std::string_view device_state_name(DeviceState state) noexcept {
  switch (state) {
    case DeviceState::kUsable:
      return "usable";
    case DeviceState::kNoPermission:
      return "no permission";
    case DeviceState::kBusy:
      return "busy";
    case DeviceState::kIgnored:
      return "ignored";
    case DeviceState::kBroken:
      return "broken";
  }
  return "broken";
}

/// One physical device, or one interface of it. Enumeration lists real devices only: simulated and replayed ones are
/// named by the user or never used.
struct DeviceInfo {
  std::string driver;  ///< name of the driver that knows it: "spacemouse", "rift", "leap", ...
  std::string path;    ///< what the driver's open takes: "/dev/hidraw3", "usb:001/004", "/dev/video0"
  std::string name;    ///< for people: "SpaceMouse Compact"
  std::string serial;  ///< empty where the device has none
  std::uint16_t vendor_id = 0, product_id = 0;
  int interface_number = -1;  ///< USB interface, -1 where not applicable
  DeviceState state = DeviceState::kUsable;
  std::string reason;  ///< why it cannot be used; empty when usable
  std::string remedy;  ///< what to do about it, a command or a udev rule; empty when usable
};

}  // namespace dubsar
