#include "devices/enumerate.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "devices/head_tracker/rift_protocol.h"
#include "devices/head_tracker/xreal_protocol.h"
#include "devices/looking_glass/calibration_pages.h"
#include "devices/spacemouse/spacemouse_protocol.h"
#include "devices/udev_rule.h"

namespace dubsar {
namespace {

constexpr std::uint16_t kGenericDesktop = 1, kMultiAxisController = 8;

int can_open(const std::string& path) { return ::access(path.c_str(), R_OK | W_OK) == 0 ? 0 : errno; }

DeviceInfo unreadable_xreal(const XrealProduct& glasses) {
  DeviceInfo info;
  info.driver = "xreal";
  info.name = glasses.name;
  info.state = DeviceState::kIgnored;
  info.reason = glasses.needs;
  info.remedy = kXrealRemedy;
  return info;
}

/// Driver and name; an empty driver where the interface is not one that a driver uses.
DeviceInfo recognise(const HidNode& node) {
  DeviceInfo info;
  switch (spacemouse_id(node.vendor_id, node.product_id)) {
    case SpaceMouseId::kSpaceMouse:
      // receivers also show a keyboard; without a usage (old kernels) the interface is taken
      if (node.usage == 0 || (node.usage_page == kGenericDesktop && node.usage == kMultiAxisController) ||
          node.usage_page >= 0xFF00)
        info.driver = "spacemouse";
      info.name = "3Dconnexion SpaceMouse";
      break;
    case SpaceMouseId::kOrdinaryMouse:
      info.driver = "spacemouse";
      info.name = "3Dconnexion mouse or keyboard";
      info.state = DeviceState::kIgnored;
      info.reason = "it is an ordinary mouse or keyboard";
      info.remedy = "none needed: the system uses it";
      break;
    case SpaceMouseId::kUnknown:
      break;
  }
  if (node.vendor_id == kRiftVendor &&
      (node.product_id == kRiftDk1 || node.product_id == kRiftDk2 || node.product_id == kRiftDk2Late)) {
    info.driver = "rift";
    info.name = node.product_id == kRiftDk1 ? "Oculus Rift DK1" : "Oculus Rift DK2";
  } else if (const XrealProduct* const glasses =
                 node.vendor_id == kXrealVendor ? find_xreal(node.product_id) : nullptr) {
    if (!glasses->needs.empty()) return unreadable_xreal(*glasses);
    if (node.interface_number == glasses->imu_interface) info.driver = "xreal";
    info.name = glasses->name;
  } else if (node.vendor_id == kLookingGlassVendor && node.product_id == kLookingGlassProduct &&
             node.product.starts_with(kLookingGlassProductName)) {
    info.driver = "looking_glass";
    info.name = "Looking Glass calibration";
  }
  return info;
}

}  // namespace

std::vector<DeviceInfo> known_hid_devices(const std::vector<HidNode>& nodes, int (*permission)(const std::string&)) {
  std::vector<DeviceInfo> known;
  for (const HidNode& node : nodes) {
    DeviceInfo info = recognise(node);
    if (info.driver.empty()) continue;
    // glasses that cannot be read are told once, not for each of their interfaces
    const auto told = [&](const DeviceInfo& d) {
      return d.driver == "xreal" && d.state == DeviceState::kIgnored && d.product_id == node.product_id &&
             d.serial == node.serial;
    };
    if (info.driver == "xreal" && info.state == DeviceState::kIgnored && std::any_of(known.begin(), known.end(), told))
      continue;
    info.path = node.path;
    if (!node.product.empty()) info.name = node.product;
    info.serial = node.serial;
    info.vendor_id = node.vendor_id;
    info.product_id = node.product_id;
    info.interface_number = node.interface_number;
    const int error = info.state == DeviceState::kUsable ? permission(node.path) : 0;
    if (error == EACCES || error == EPERM) {
      info.state = DeviceState::kNoPermission;
      info.reason = fmt::format("this user may not open {}", node.path);
      info.remedy =
          fmt::format("{}; the rule is: {}", kUdevRemedy, udev_rule("hidraw", node.vendor_id, node.product_id));
    } else if (error == EBUSY) {
      info.state = DeviceState::kBusy;
      info.reason = "another program holds it";
      info.remedy = "end that program (lsof " + node.path + ")";
    } else if (error != 0) {
      info.state = DeviceState::kBroken;
      info.reason = fmt::format("{}: {}", node.path, std::strerror(error));
      info.remedy = "plug the device in again";
    }
    known.push_back(std::move(info));
  }
  return known;
}

std::optional<DeviceInfo> unreadable_glasses(UsbId id, const std::string& path) {
  const XrealProduct* const glasses = id.vendor == kXrealVendor ? find_xreal(id.product) : nullptr;
  if (glasses == nullptr || glasses->needs.empty()) return std::nullopt;
  DeviceInfo info = unreadable_xreal(*glasses);
  info.path = path;
  info.vendor_id = id.vendor;
  info.product_id = id.product;
  return info;
}

std::vector<DeviceInfo> list_hid_devices() { return known_hid_devices(list_hid_nodes(), can_open); }

Result<std::unique_ptr<Transport>> open_hid_device(std::string_view driver, const Clock& clock) {
  Error error{ErrorKind::kUnavailable, fmt::format("{}: no such device is plugged in", driver)};
  for (const DeviceInfo& info : list_hid_devices()) {
    if (info.driver != driver) continue;
    if (info.state == DeviceState::kIgnored) {
      if (error.message.ends_with("plugged in"))
        error.message = fmt::format("{}: {}: {}; {}", driver, info.name, info.reason, info.remedy);
      continue;
    }
    if (info.state == DeviceState::kUsable) {
      auto opened = open_hid(info.path, clock, {info.vendor_id, info.product_id});
      if (opened) return opened;
      error = std::move(opened).error();
    } else {
      error = {info.state == DeviceState::kNoPermission ? ErrorKind::kPermission : ErrorKind::kUnavailable,
               fmt::format("{}: {}; {}", driver, info.reason, info.remedy)};
    }
  }
  return tl::unexpected<Error>(std::move(error));
}

std::vector<DeviceInfo> list_spacenavd(const std::string& socket_path) {
  if (::access(socket_path.c_str(), F_OK) != 0) return {};
  DeviceInfo info;
  info.driver = "spacenav";
  info.path = socket_path;
  info.name = "spacenavd";
  if (const int error = can_open(socket_path); error != 0) {
    info.state = DeviceState::kNoPermission;
    info.reason = fmt::format("this user may not connect to {}", socket_path);
    info.remedy = "chmod a+rw " + socket_path;
  }
  return {info};
}

}  // namespace dubsar
