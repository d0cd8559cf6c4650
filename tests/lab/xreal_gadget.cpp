#include "tests/lab/xreal_gadget.h"

#include <algorithm>
#include <cstring>

namespace dubsar::lab {
namespace {

using std::chrono::steady_clock;

constexpr std::array<std::uint8_t, 18> kDevice{18,
                                               1,
                                               0x00,
                                               0x02,
                                               0,
                                               0,
                                               0,
                                               64,
                                               kXrealVendor & 0xFF,
                                               kXrealVendor >> 8,
                                               XrealGadget::kAir & 0xFF,
                                               XrealGadget::kAir >> 8,
                                               0x00,
                                               0x01,
                                               1,
                                               2,
                                               0,
                                               1};

// Vendor-defined usages, 64 bytes in and 64 bytes out, no report numbers.
constexpr std::array<std::uint8_t, 27> kReportDescriptor{0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00,
                                                         0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x40, 0x09, 0x02,
                                                         0x81, 0x02, 0x09, 0x03, 0x95, 0x40, 0x91, 0x02, 0xC0};

std::vector<std::uint8_t> configuration() {
  std::vector<std::uint8_t> bytes{9, 2, 0, 0, 5, 1, 0, 0x80, 250};
  const auto add = [&](std::initializer_list<unsigned> values) {
    for (const unsigned value : values) bytes.push_back(static_cast<std::uint8_t>(value));
  };
  for (unsigned interface = 0; interface < 5; ++interface) {
    const bool hid = interface >= XrealGadget::kInertialInterface;
    add({9, 4, interface, 0, hid ? 2U : 0U, hid ? 3U : 0xFFU, 0, 0, 0});
    if (!hid) continue;
    add({9, 0x21, 0x11, 0x01, 0, 1, 0x22, kReportDescriptor.size(), 0});
    add({7, 5, 0x80U | interface, 3, 64, 0, 4});  // interrupt
    add({7, 5, interface, 3, 64, 0, 4});
  }
  bytes[2] = static_cast<std::uint8_t>(bytes.size() & 0xFFU);
  bytes[3] = static_cast<std::uint8_t>(bytes.size() >> 8);
  return bytes;
}

}  // namespace

XrealGadget::XrealGadget(const glm::dvec3& rate_rad_s, int turning_reports)
    : rate_rad_s_(rate_rad_s), turning_reports_(turning_reports), configuration_(configuration()) {
  switch_off();
}

void XrealGadget::switch_off() {
  wire_.reset();
  glasses_ = std::make_unique<XrealSim>();
  wire_ = std::move(glasses_->device().open().value());
  reports_ = 0;
}

std::span<const std::uint8_t> XrealGadget::device_descriptor() const { return kDevice; }

Result<std::size_t> XrealGadget::control(const ControlRequest& request, std::span<std::byte> data) {
  constexpr std::uint8_t kGetDescriptor = 6, kSetIdle = 10;
  constexpr std::uint16_t kReport = 0x2200;
  if (request.request_type == 0x81 && request.request == kGetDescriptor && request.value == kReport) {
    const std::size_t length = std::min(data.size(), kReportDescriptor.size());
    std::memcpy(data.data(), kReportDescriptor.data(), length);
    return length;
  }
  if (request.request_type == 0x21 && request.request == kSetIdle) return 0U;
  return fail(ErrorKind::kBadData, "simulated XREAL: stall of request {:#x}", request.request);
}

std::optional<std::size_t> XrealGadget::send(std::uint8_t endpoint, std::span<std::byte> data) {
  if (endpoint != (0x80 | kInertialInterface)) return std::nullopt;
  if (glasses_->streaming() && steady_clock::now() >= due_) {
    due_ = steady_clock::now() + kPeriod;
    glasses_->step(reports_++ < turning_reports_ ? rate_rad_s_ : glm::dvec3(0.0), 1e-3 * kPeriod.count());
  }
  const auto length = wire_->read(data, milliseconds(0));
  return length && *length > 0 ? std::optional(*length) : std::nullopt;
}

Result<void> XrealGadget::receive(std::uint8_t endpoint, std::span<const std::byte> data) {
  if (endpoint != kInertialInterface) return {};
  return wire_->write(data);
}

}  // namespace dubsar::lab
