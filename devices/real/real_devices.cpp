#include "devices/real/real_devices.h"

#include <algorithm>

#include "devices/camera/camera.h"
#include "devices/enumerate.h"
#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/vrpn_protocol.h"
#include "devices/leap/leap_camera.h"
#include "devices/spacemouse/spacenav_protocol.h"
#include "devices/transport/socket_transport.h"
#include "devices/transport/usb_transport.h"
#include "devices/udev_rule.h"

namespace dubsar {
namespace {

constexpr milliseconds kConnectTimeout{1000};

/// The first of the Leap cameras that can be read over USB; those that cannot say what to use instead.
Result<std::unique_ptr<Transport>> open_leap() {
  std::string instead;
  DUBSAR_ASSIGN(const auto present, list_usb_devices());
  for (const LeapProduct& product : leap_products())
    for (const UsbDevice& device : present) {
      if (device.vendor_id != product.vendor_id || device.product_id != product.product_id) continue;
      if (!product.by_usb) {
        instead = fmt::format("leap: {}: {}; {}", product.name, kLeapServiceReason, kLeapServiceRemedy);
        continue;
      }
      UsbOpenOptions options;
      options.camera = true;
      options.transfer_bytes = kStereoTransferBytes;
      return open_usb_transport(product.vendor_id, product.product_id, options, device.path);
    }
  return fail(ErrorKind::kUnavailable, "{}",
              instead.empty() ? std::string("leap: no such device is plugged in") : instead);
}

Result<OpenTransport> reach_opentrack(const DeviceSpec& choice, const Clock& clock) {
  DUBSAR_TRY(check_listen_address(choice.address, choice.allow_remote));
  UdpOptions options;
  options.address = choice.address;
  options.port = choice.port == 0 ? kOpentrackPort : static_cast<std::uint16_t>(choice.port);
  options.allow_remote = choice.allow_remote;
  options.accept = [](std::span<const std::byte> datagram) { return parse_opentrack(datagram).has_value(); };
  return OpenTransport([options, &clock]() -> Result<std::unique_ptr<Transport>> {
    DUBSAR_ASSIGN(auto listener, open_udp(options, clock));
    return listener;
  });
}

Result<OpenTransport> reach_vrpn(const DeviceSpec& choice) {
  DUBSAR_TRY(check_host(choice.address));
  const std::uint16_t port = choice.port == 0 ? kVrpnPort : static_cast<std::uint16_t>(choice.port);
  return OpenTransport([address = choice.address, port] {
    return open_tcp_stream(address, port, kConnectTimeout, TcpClosing::kAtOnce);
  });
}

}  // namespace

Result<OpenTransport> reach_real_device(const DeviceSpec& choice, const Clock& clock) {
  if (choice.driver == "spacemouse" || choice.driver == "rift" || choice.driver == "xreal")
    return OpenTransport([driver = choice.driver, &clock] { return open_hid_device(driver, clock); });
  if (choice.driver == "spacenav")
    return OpenTransport(
        [path = choice.socket.empty() ? kSpacenavSocket : choice.socket] { return open_unix_stream(path); });
  if (choice.driver == "vrpn") return reach_vrpn(choice);
  if (choice.driver == "opentrack") return reach_opentrack(choice, clock);
  if (choice.driver == "leap") return OpenTransport(open_leap);
  return fail(ErrorKind::kUsage, "devices: \"{}\" found, expected one of: {}", choice.driver, kDeviceDrivers);
}

std::vector<DeviceInfo> list_real_devices(const std::string& spacenav_socket) {
  std::vector<DeviceInfo> devices = list_hid_devices();
  const auto usb = list_usb_devices();
  for (const UsbDevice& device : usb ? *usb : std::vector<UsbDevice>{}) {
    if (auto glasses = unreadable_glasses({device.vendor_id, device.product_id}, device.path);
        glasses && std::none_of(devices.begin(), devices.end(), [&](const DeviceInfo& d) {
          return d.vendor_id == device.vendor_id && d.product_id == device.product_id;
        }))
      devices.push_back(*std::move(glasses));
    const LeapProduct* const product = find_leap_product(device.vendor_id, device.product_id);
    if (product == nullptr) continue;
    DeviceInfo info;
    info.driver = product->by_usb ? "leap" : "leapc";
    info.path = device.path;
    info.name = product->name;
    info.vendor_id = device.vendor_id;
    info.product_id = device.product_id;
    if (!product->by_usb) {
      info.state = DeviceState::kIgnored;
      info.reason = kLeapServiceReason;
      info.remedy = kLeapServiceRemedy;
    } else if (!device.accessible) {
      info.state = DeviceState::kNoPermission;
      info.reason = fmt::format("this user may not open {}", device.node);
      info.remedy = fmt::format("{}; the rule is: {}", kUdevRemedy, usb_udev_rule(device.vendor_id, device.product_id));
    }
    devices.push_back(std::move(info));
  }
  for (DeviceInfo& info : list_spacenavd(spacenav_socket.empty() ? kSpacenavSocket : spacenav_socket))
    devices.push_back(std::move(info));
  for (DeviceInfo& info : list_cameras()) devices.push_back(std::move(info));
  return devices;
}

}  // namespace dubsar
