#include "devices/device_list.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "devices/camera/webcam.h"
#include "devices/spacemouse/spacenav_protocol.h"
#include "devices/transport/hid_transport.h"
#include "devices/transport/usb_transport.h"
#include "devices/udev_rule.h"

namespace dubsar {
namespace {

constexpr std::uint16_t kGenericDesktop = 1, kMultiAxisController = 8, kVendorPages = 0xFF00;

int can_read(const std::string& path) { return ::access(path.c_str(), R_OK) == 0 ? 0 : errno; }
int can_open(const std::string& path) { return ::access(path.c_str(), R_OK | W_OK) == 0 ? 0 : errno; }

bool fits(const DeviceId& id, std::uint16_t vendor, std::uint16_t product) {
  return id.vendor == vendor && (id.product == product || id.product == 0);
}

bool fits(const DeviceId& id, const HidNode& node) {
  if (!fits(id, node.vendor_id, node.product_id) || !node.product.starts_with(id.product_name)) return false;
  if (id.interface_number >= 0 && id.interface_number != node.interface_number) return false;
  return !id.multi_axis_use || node.usage == 0 ||  // old kernels tell no usage
         (node.usage_page == kGenericDesktop && node.usage == kMultiAxisController) || node.usage_page >= kVendorPages;
}

DeviceInfo describe(const DriverEntry& driver, const DeviceId& id, std::uint16_t product) {
  DeviceInfo info;
  info.driver = driver.name;
  info.name = id.name;
  info.vendor_id = id.vendor;
  info.product_id = product;
  if (id.ignored.empty()) return info;
  info.state = DeviceState::kIgnored;
  info.reason = id.ignored;
  info.remedy = id.instead;
  return info;
}

void explain(DeviceInfo& info, int error, const std::string& rule) {
  if (error == 0 || info.state != DeviceState::kUsable) return;
  if (error == EACCES || error == EPERM) {
    info.state = DeviceState::kNoPermission;
    info.reason = fmt::format("this user may not open {}", info.path);
    info.remedy = fmt::format("{}; the rule is: {}", kUdevRemedy, rule);
  } else {
    info.state = DeviceState::kBroken;
    info.reason = fmt::format("{}: {}", info.path, std::strerror(error));
    info.remedy = "plug the device in again";
  }
}

/// Of a device that is there and cannot be used.
Error why_not(const DriverEntry& driver, const DeviceInfo& info) {
  return {info.state == DeviceState::kNoPermission ? ErrorKind::kPermission : ErrorKind::kUnavailable,
          fmt::format("{}: {}; {}", driver.name, info.reason, info.remedy)};
}

}  // namespace

std::vector<DeviceInfo> known_hid_devices(const std::vector<HidNode>& nodes, int (*permission)(const std::string&),
                                          DriverTable drivers) {
  std::vector<DeviceInfo> known;
  for (const HidNode& node : nodes)
    for (const DriverEntry& driver : drivers) {
      if (driver.bus != Bus::kHid) continue;
      const auto id =
          std::find_if(driver.ids.begin(), driver.ids.end(), [&](const DeviceId& i) { return fits(i, node); });
      if (id == driver.ids.end()) continue;
      DeviceInfo info = describe(driver, *id, node.product_id);
      info.path = node.path;
      if (!node.product.empty()) info.name = node.product;
      info.serial = node.serial;
      info.interface_number = node.interface_number;
      if (info.state == DeviceState::kUsable)
        explain(info, permission(node.path), udev_rule("hidraw", info.vendor_id, info.product_id));
      // what is left alone is told once, not for each of its interfaces
      const bool told =
          info.state == DeviceState::kIgnored && std::any_of(known.begin(), known.end(), [&](const DeviceInfo& d) {
            return d.driver == info.driver && d.product_id == info.product_id && d.serial == info.serial;
          });
      if (!told) known.push_back(std::move(info));
      break;
    }
  return known;
}

std::vector<DeviceInfo> known_usb_devices(const std::vector<UsbDevice>& present, DriverTable drivers) {
  std::vector<DeviceInfo> known;
  for (const UsbDevice& device : present)
    for (const DriverEntry& driver : drivers) {
      if (driver.bus != Bus::kUsb && driver.bus != Bus::kService && driver.bus != Bus::kHid) continue;
      const auto id = std::find_if(driver.ids.begin(), driver.ids.end(),
                                   [&](const DeviceId& i) { return fits(i, device.vendor_id, device.product_id); });
      if (id == driver.ids.end() || (driver.bus == Bus::kHid && id->ignored.empty())) continue;
      DeviceInfo& info = known.emplace_back(describe(driver, *id, device.product_id));
      info.path = device.path;
      if (device.accessible || info.state != DeviceState::kUsable) continue;
      info.state = DeviceState::kNoPermission;
      info.reason = fmt::format("this user may not open {}", device.node);
      info.remedy =
          fmt::format("{}; the rule is: {}", kUdevRemedy, udev_rule("usb", device.vendor_id, device.product_id));
    }
  return known;
}

std::vector<DeviceInfo> known_touch_panels(const std::vector<EvdevNode>& nodes, int (*permission)(const std::string&),
                                           DriverTable drivers) {
  std::vector<DeviceInfo> known;
  for (const DriverEntry& driver : drivers)
    for (const EvdevNode& node : nodes) {
      if (driver.bus != Bus::kInput || !node.touch_panel) continue;
      DeviceInfo& info = known.emplace_back();
      info.driver = driver.name;
      info.path = node.path;
      info.name = node.name.empty() ? driver.summary : node.name;
      info.vendor_id = node.vendor_id;
      info.product_id = node.product_id;
      if (node.slots) {
        explain(info, permission(node.path), std::string(kTouchRule));
        continue;
      }
      info.state = DeviceState::kIgnored;
      info.reason = "it does not tell its contacts apart (multi-touch type A), which this program does not read";
      info.remedy = "none: the window system makes a mouse of it";
    }
  return known;
}

Result<std::unique_ptr<Transport>> open_touch_panel(const DriverEntry& driver, const std::string& path) {
  Error error{ErrorKind::kUnavailable, path.empty() ? fmt::format("{}: no such device is plugged in", driver.name)
                                                    : fmt::format("{}: {} is no touch panel", driver.name, path)};
  for (const DeviceInfo& info : known_touch_panels(list_evdev_nodes(), can_read, {&driver, 1})) {
    if (!path.empty() && info.path != path) continue;
    if (info.state == DeviceState::kUsable) {
      auto opened = open_evdev(info.path, {info.vendor_id, info.product_id});
      if (opened) return opened;
      error = std::move(opened).error();
    } else {
      error = why_not(driver, info);
    }
  }
  return tl::unexpected<Error>(std::move(error));
}

std::vector<DeviceInfo> list_hid_devices(DriverTable drivers) {
  return known_hid_devices(list_hid_nodes(), can_open, drivers);
}

Result<std::unique_ptr<Transport>> open_hid_device(const DriverEntry& driver, const Clock& clock) {
  Error error{ErrorKind::kUnavailable, fmt::format("{}: no such device is plugged in", driver.name)};
  for (const DeviceInfo& info : list_hid_devices({&driver, 1})) {
    if (info.state == DeviceState::kIgnored) {
      if (error.message.ends_with("plugged in"))
        error.message = fmt::format("{}: {}: {}; {}", driver.name, info.name, info.reason, info.remedy);
      continue;
    }
    if (info.state == DeviceState::kUsable) {
      auto opened = open_hid(info.path, clock, {info.vendor_id, info.product_id});
      if (opened) return opened;
      error = std::move(opened).error();
    } else {
      error = why_not(driver, info);
    }
  }
  return tl::unexpected<Error>(std::move(error));
}

Result<std::unique_ptr<Transport>> open_hid_device(std::string_view driver, const Clock& clock) {
  DUBSAR_ASSIGN(const DriverEntry* row, find_driver(driver, "devices", driver_table()));
  return open_hid_device(*row, clock);
}

std::vector<DeviceInfo> list_socket(const DriverEntry& driver, const std::string& path) {
  if (::access(path.c_str(), F_OK) != 0) return {};
  DeviceInfo info;
  info.driver = driver.name;
  info.path = path;
  info.name = driver.summary;
  if (const int error = can_open(path); error != 0) {
    info.state = DeviceState::kNoPermission;
    info.reason = fmt::format("this user may not connect to {}", path);
    info.remedy = "chmod a+rw " + path;
  }
  return {info};
}

std::vector<DeviceInfo> list_devices(const std::string& spacenav_socket, DriverTable drivers) {
  std::vector<DeviceInfo> devices = list_hid_devices(drivers);
  const auto add = [&](std::vector<DeviceInfo> more) {
    devices.insert(devices.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  const auto usb = list_usb_devices();
  for (DeviceInfo& info : known_usb_devices(usb ? *usb : std::vector<UsbDevice>{}, drivers)) {
    const bool told = std::any_of(devices.begin(), devices.end(), [&](const DeviceInfo& d) {
      return d.driver == info.driver && d.vendor_id == info.vendor_id && d.product_id == info.product_id &&
             info.state == DeviceState::kIgnored;  // by HID
    });
    if (!told) devices.push_back(std::move(info));
  }
  add(known_touch_panels(list_evdev_nodes(), can_read, drivers));
  for (const DriverEntry& driver : drivers) {
    if (driver.bus == Bus::kUnixSocket)
      add(list_socket(driver, spacenav_socket.empty() ? kSpacenavSocket : spacenav_socket));
    if (driver.bus == Bus::kVideo) add(list_cameras());
  }
  return devices;
}

std::vector<const DriverEntry*> taken_unasked(const std::vector<DeviceInfo>& present, DriverTable drivers) {
  const auto usable = [&](std::string_view name) {
    return std::any_of(present.begin(), present.end(), [&](const DeviceInfo& info) {
      return info.driver == name && info.state == DeviceState::kUsable;
    });
  };
  std::vector<const DriverEntry*> out;
  for (const DriverEntry& driver : drivers) {
    if (!driver.input.taken_unasked || !usable(driver.name)) continue;
    const bool held = std::any_of(drivers.begin(), drivers.end(), [&](const DriverEntry& other) {
      return other.input.instead_of == driver.name && other.input.taken_unasked && usable(other.name);
    });
    if (!held) out.push_back(&driver);
  }
  return out;
}

}  // namespace dubsar
