#include "devices/drivers.h"

#include <algorithm>
#include <array>
#include <vector>

#include "devices/device_list.h"
#include "devices/driver.h"
#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/rift_protocol.h"
#include "devices/head_tracker/simulated_heads.h"
#include "devices/head_tracker/vrpn_protocol.h"
#include "devices/head_tracker/vrpn_server.h"
#include "devices/head_tracker/xreal_protocol.h"
#include "devices/leap/leap_driver.h"
#include "devices/leap/simulated_leap.h"
#include "devices/looking_glass/calibration_pages.h"
#include "devices/spacemouse/simulated_spacemice.h"
#include "devices/spacemouse/spacenav_protocol.h"
#include "devices/touch/simulated_touch.h"
#include "devices/touch/touch_protocol.h"
#include "devices/transport/socket_transport.h"
#include "devices/transport/usb_transport.h"

namespace dubsar {
namespace {

constexpr milliseconds kConnectTimeout{1000};
constexpr std::string_view kLocalHost = "127.0.0.1";
constexpr std::string_view kNeckModel =
    "measures where the head looks, not where it is; its place is that of a neck model";

constexpr std::uint16_t kLogitech = 0x046d, k3Dconnexion = 0x256f;
constexpr DeviceId space_mouse(std::uint16_t product) {
  return {.vendor = kLogitech, .product = product, .name = "3Dconnexion SpaceMouse", .multi_axis_use = true};
}
constexpr DeviceId ordinary(std::uint16_t product) {
  return {.vendor = k3Dconnexion,
          .product = product,
          .name = "3Dconnexion mouse or keyboard",
          .ignored = "it is an ordinary mouse or keyboard",
          .instead = "none needed: the system uses it"};
}
// spacenavd src/dev.c: the table of devices with their flags, and the black list. Vendor 256f makes little else than
// six-axis 3D mice: products of his that are not known are taken for one.
constexpr std::array kSpaceMouseIds{
    space_mouse(0xc603), space_mouse(0xc605),
    space_mouse(0xc606), space_mouse(0xc621),
    space_mouse(0xc623), space_mouse(0xc625),
    space_mouse(0xc626), space_mouse(0xc627),
    space_mouse(0xc628), space_mouse(0xc629),
    space_mouse(0xc62b), space_mouse(0xc640),
    ordinary(0xc62c),    ordinary(0xc641),
    ordinary(0xc650),    ordinary(0xc651),
    ordinary(0xc654),    ordinary(0xc655),
    ordinary(0xc656),    ordinary(0xc657),
    ordinary(0xc658),    ordinary(0xc664),
    ordinary(0xc665),    ordinary(0xc667),
    ordinary(0xc668),    DeviceId{.vendor = k3Dconnexion, .name = "3Dconnexion SpaceMouse", .multi_axis_use = true}};
constexpr std::array<DeviceId, 3> kRiftIds{{{kRiftVendor, kRiftDk1, "Oculus Rift DK1"},
                                            {kRiftVendor, kRiftDk2, "Oculus Rift DK2"},
                                            {kRiftVendor, kRiftDk2Late, "Oculus Rift DK2"}}};
constexpr std::array<DeviceId, 1> kLookingGlassIds{{{.vendor = kLookingGlassVendor,
                                                     .product = kLookingGlassProduct,
                                                     .name = "Looking Glass calibration",
                                                     .product_name = kLookingGlassProductName}}};

/// The inertial interface of each model that can be read; what the others need.
std::vector<DeviceId> xreal_ids() {
  std::vector<DeviceId> ids;
  for (const XrealProduct& model : xreal_products())
    ids.push_back({.vendor = kXrealVendor,
                   .product = model.id,
                   .name = model.name,
                   .interface_number = model.imu_interface,
                   .ignored = model.needs,
                   .instead = model.needs.empty() ? std::string_view() : kXrealRemedy});
  return ids;
}

std::vector<DeviceId> leap_ids(bool by_usb) {
  std::vector<DeviceId> ids;
  for (const LeapProduct& product : leap_products()) {
    if (product.by_usb != by_usb) continue;
    DeviceId& id = ids.emplace_back(DeviceId{product.vendor_id, product.product_id, product.name});
    if (by_usb) continue;
    id.ignored = kLeapServiceReason;
    id.instead = kLeapServiceRemedy;
  }
  return ids;
}

Result<OpenTransport> open_first_hid(const DriverEntry& self, OptionReader&, const Clock& clock) {
  return OpenTransport([&self, &clock] { return open_hid_device(self, clock); });
}

Result<OpenTransport> open_spacenav(const DriverEntry&, OptionReader& options, const Clock&) {
  return OpenTransport([path = options.text("socket", kSpacenavSocket)] { return open_unix_stream(path); });
}

Result<OpenTransport> open_opentrack(const DriverEntry&, OptionReader& options, const Clock& clock) {
  UdpOptions udp;
  udp.address = options.text("address", kLocalHost);
  udp.port = static_cast<std::uint16_t>(options.integer("port", 1, 65535, kOpentrackPort));
  udp.allow_remote = options.flag("remote");
  udp.accept = [](std::span<const std::byte> datagram) { return parse_opentrack(datagram).has_value(); };
  DUBSAR_TRY(check_listen_address(udp.address, udp.allow_remote));
  return OpenTransport([udp, &clock]() -> Result<std::unique_ptr<Transport>> {
    DUBSAR_ASSIGN(auto listener, open_udp(udp, clock));
    return listener;
  });
}

Result<OpenTransport> open_vrpn(const DriverEntry&, OptionReader& options, const Clock&) {
  const std::string address = options.text("address", kLocalHost);
  const auto port = static_cast<std::uint16_t>(options.integer("port", 1, 65535, kVrpnPort));
  DUBSAR_TRY(check_host(address));
  return OpenTransport(
      [address, port] { return open_tcp_stream(address, port, kConnectTimeout, TcpClosing::kAtOnce); });
}

/// The first of the Leap cameras that can be read over USB; those that cannot say what to use instead.
Result<std::unique_ptr<Transport>> open_leap_now() {
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
      options.transfers_in_flight = kStereoTransfersInFlight;
      return open_usb_transport(product.vendor_id, product.product_id, options, device.path);
    }
  return fail(ErrorKind::kUnavailable, "{}",
              instead.empty() ? std::string("leap: no such device is plugged in") : instead);
}
Result<OpenTransport> open_leap(const DriverEntry&, OptionReader&, const Clock&) {
  return OpenTransport(open_leap_now);
}

Result<OpenTransport> open_touch(const DriverEntry& self, OptionReader& options, const Clock&) {
  return OpenTransport([&self, path = options.text("device")] { return open_touch_panel(self, path); });
}

template <class Protocol>
std::unique_ptr<DeviceDriver> drive(OpenTransport open, OptionReader&, const Clock* stamps) {
  return std::make_unique<Driver<Protocol>>(std::move(open), Protocol(), stamps);
}

/// "x+yaw" and the like.
Result<OpentrackInvert> parse_axes(std::string_view text) {
  static constexpr std::array<std::string_view, 6> kAxes{"x", "y", "z", "yaw", "pitch", "roll"};
  OpentrackInvert out{};
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find('+'));
    const auto found = std::find(kAxes.begin(), kAxes.end(), word);
    if (found == kAxes.end())
      return fail(ErrorKind::kUsage, "invert: \"{}\" found, expected x, y, z, yaw, pitch and roll joined by +", word);
    out[static_cast<std::size_t>(found - kAxes.begin())] = true;
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return out;
}

std::unique_ptr<DeviceDriver> drive_opentrack(OpenTransport open, OptionReader& options, const Clock* stamps) {
  const auto invert = parse_axes(options.text("invert"));
  if (!invert) options.complain(invert.error().message);
  const auto sender = parse_opentrack_sender(options.text("sender"));
  if (!sender) options.complain(sender.error().message);
  OpentrackProtocol protocol(invert.value_or(OpentrackInvert{}), sender.value_or(std::nullopt));
  return std::make_unique<Driver<OpentrackProtocol>>(std::move(open), protocol, stamps);
}

std::unique_ptr<DeviceDriver> drive_vrpn(OpenTransport open, OptionReader& options, const Clock* stamps) {
  VrpnChoice choice;
  choice.tracker = options.text("tracker");
  choice.sensor = options.integer("sensor", 0, 1000, 0);
  return std::make_unique<Driver<VrpnProtocol>>(std::move(open), VrpnProtocol(std::move(choice)), stamps);
}

std::unique_ptr<DeviceDriver> drive_touch(OpenTransport open, OptionReader& options, const Clock* stamps) {
  const int turn_deg = options.integer("turn", 0, 270, 0);
  if (turn_deg % 90 != 0) options.complain(fmt::format("turn: {} found, expected 0, 90, 180 or 270", turn_deg));
  return std::make_unique<Driver<TouchProtocol>>(std::move(open), TouchProtocol(turn_deg), stamps);
}

const Pose kBeforeThePanel{{0.0, 0.0, 0.6}, {1.0, 0.0, 0.0, 0.0}};  ///< where the viewer sits
const Pose kOnTheTable{{0.0, -0.2, 0.15}, {1.0, 0.0, 0.0, 0.0}};    ///< facing up

std::vector<DriverEntry> make_table() {
  static const std::vector<DeviceId> xreal_devices = xreal_ids(), leap_devices = leap_ids(true),
                                     leap_service_devices = leap_ids(false);
  return {
      {.name = "spacemouse",
       .summary = "3Dconnexion SpaceMouse, all USB models and receivers",
       .bus = Bus::kHid,
       .ids = kSpaceMouseIds,
       .bluetooth_vendor = 0x256f,
       .gives = Gives::kSpaceMouse,
       .input = {.source = "spacemouse", .taken_unasked = true},
       .open = open_first_hid,
       .drive = drive<SpaceMouseProtocol>,
       .simulate = simulate_spacemouse},
      {.name = "spacenav",
       .summary = "spacenavd daemon",
       .bus = Bus::kUnixSocket,
       .gives = Gives::kSpaceMouse,
       .input = {.source = "spacenav", .taken_unasked = true, .instead_of = "spacemouse"},  // the daemon holds it
       .open = open_spacenav,
       .drive = drive<SpacenavProtocol>,
       .simulate = simulate_spacenav},
      {.name = "opentrack",
       .summary = "opentrack, AITrack, Tobii_Linux, telephones, XRLinuxDriver (UDP)",
       .bus = Bus::kUdp,
       .gives = Gives::kHead,
       .input = {.source = "head:opentrack"},
       .usual_place = kBeforeThePanel,
       .port = kOpentrackPort,
       .open = open_opentrack,
       .drive = drive_opentrack,
       .simulate = simulate_opentrack},
      {.name = "vrpn",
       .summary = "any VRPN tracker (TCP, version 07)",
       .bus = Bus::kTcp,
       .gives = Gives::kHead,
       .input = {.source = "head:vrpn"},
       .port = kVrpnPort,
       .calls = parse_vrpn_call,
       .open = open_vrpn,
       .drive = drive_vrpn,
       .simulate = simulate_vrpn},
      {.name = "rift",
       .summary = "Oculus Rift DK1, DK2 (orientation)",
       .bus = Bus::kHid,
       .ids = kRiftIds,
       .gives = Gives::kHead,
       .input = {.source = "head:rift", .taken_unasked = true, .lacks = kNeckModel},
       .usual_place = kBeforeThePanel,
       .open = open_first_hid,
       .drive = drive<RiftProtocol>,
       .simulate = simulate_rift},
      {.name = "xreal",
       .summary = "XREAL Air, Air 2, Air 2 Pro, Air 2 Ultra (orientation)",
       .bus = Bus::kHid,
       .ids = xreal_devices,
       .gives = Gives::kHead,
       .input = {.source = "head:xreal", .taken_unasked = true, .lacks = kNeckModel},
       .usual_place = kBeforeThePanel,
       .open = open_first_hid,
       .drive = drive<XrealProtocol>,
       .simulate = simulate_xreal},
      {.name = "leap",
       .summary = "Leap Motion Controller, Rigel, Stereo IR 170",
       .bus = Bus::kUsb,
       .ids = leap_devices,
       .gives = Gives::kStereoPictures,
       .input = {.source = "leap", .taken_unasked = true},
       .usual_place = kOnTheTable,
       .open = open_leap,
       .drive = drive_leap,
       .simulate = simulate_leap,
       .longest_simulation_s = 10.0},  // 70 MB a second
      {.name = "touch",
       .summary = "touch panels (kernel multi-touch, type B)",
       .bus = Bus::kInput,
       .gives = Gives::kTouches,
       .input = {.source = "touch", .taken_unasked = true, .whole_screen = true},
       .open = open_touch,
       .drive = drive_touch,
       .simulate = simulate_touch},
      {.name = "leapc",
       .summary = "Leap Motion Controller 2, 3Di",
       .bus = Bus::kService,
       .ids = leap_service_devices,
       .gives = Gives::kHands,
       .input = {.source = "leapc"},
       .usual_place = kOnTheTable},
      {.name = "webcam",
       .summary = "webcams (Video4Linux)",
       .bus = Bus::kVideo,
       .gives = Gives::kPictures,
       .input = {.source = "webcam"}},
      {.name = "looking_glass",
       .summary = "Looking Glass 8.9\", 15.6\", 8K (calibration by HID)",
       .bus = Bus::kHid,
       .ids = kLookingGlassIds,
       .open = open_first_hid},
  };
}

}  // namespace

DriverTable driver_table() {
  static const std::vector<DriverEntry> table = make_table();
  return table;
}

std::string driver_names(DriverTable drivers, bool (*passes)(const DriverEntry&)) {
  std::string names;
  for (const DriverEntry& driver : drivers)
    if (passes(driver)) names += (names.empty() ? "" : ", ") + std::string(driver.name);
  return names;
}

Result<const DriverEntry*> find_driver(std::string_view name, std::string_view whose, DriverTable drivers) {
  for (const DriverEntry& driver : drivers)
    if (driver.name == name) return &driver;
  return fail(ErrorKind::kUsage, "{}: \"{}\" found, expected one of: {}", whose, name,
              driver_names(drivers, [](const DriverEntry&) { return true; }));
}

namespace {
Result<const DriverEntry*> find_readable(const DeviceSpec& spec, DriverTable drivers) {
  for (const DriverEntry& driver : drivers)
    if (driver.name == spec.driver && can_be_opened(driver)) return &driver;
  return fail(ErrorKind::kUsage, "devices: \"{}\" found, expected one of: {}", spec.driver,
              driver_names(drivers, can_be_opened));
}
}  // namespace

Result<OpenTransport> open_device(const DeviceSpec& spec, const Clock& clock, DriverTable drivers) {
  DUBSAR_ASSIGN(const DriverEntry* driver, find_readable(spec, drivers));
  OptionReader options(spec.options, fmt::format("device {}", spec.driver));
  DUBSAR_ASSIGN(OpenTransport open, driver->open(*driver, options, clock));
  DUBSAR_TRY(options.status());
  return open;
}

Result<std::unique_ptr<DeviceDriver>> drive_device(const DeviceSpec& spec, OpenTransport open, const Clock& clock,
                                                   DriverTable drivers) {
  DUBSAR_ASSIGN(const DriverEntry* driver, find_readable(spec, drivers));
  OptionReader options(spec.options, fmt::format("device {}", spec.driver));
  DUBSAR_TRY(driver->open(*driver, options, clock));  // takes its options; nothing is opened
  auto made = driver->drive(std::move(open), options, &clock);
  DUBSAR_TRY(options.finish());
  return made;
}

}  // namespace dubsar
