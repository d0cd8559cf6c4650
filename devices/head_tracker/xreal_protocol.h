#pragma once
// XREAL (Nreal) Air glasses over HID: the inertial interface. Facts: badicsalex/ar-drivers-rs src/nreal_air.rs.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "devices/head_tracker/head_sample.h"
#include "devices/head_tracker/imu_fusion.h"
#include "devices/transport/device_timeline.h"
#include "devices/transport/transport.h"

namespace dubsar {

inline constexpr std::uint16_t kXrealVendor = 0x3318;

struct XrealProduct {
  std::uint16_t id = 0;
  std::string_view name;
  int imu_interface = -1;  ///< the HID interface that carries the inertial reports; -1: not one that is known
  std::string_view needs;  ///< why this program cannot read it and what can; empty where it can
};
/// The models that XRLinuxDriver knows (src/devices/xreal.c).
std::span<const XrealProduct> xreal_products() noexcept;
inline constexpr std::string_view kXrealRemedy =
    "run XRLinuxDriver with its opentrack output and use head:opentrack,sender=xrlinux";

struct XrealReport {
  std::uint64_t time_ns = 0;  ///< the glasses' clock
  ImuSample sample;           ///< head axes
};

/// 64 bytes that start 01 02. A scale with divisor 0, more than 4000 degrees/s or 64 g: nothing.
std::optional<XrealReport> parse_xreal(std::span<const std::byte> report) noexcept;
/// The inverse, with full scales of 2000 degrees/s and 16 g in 24 bits.
std::array<std::byte, 64> format_xreal(const XrealReport& report) noexcept;

/// A command and its answer: AA, CRC-32 of what follows, length, number, data.
struct XrealCommand {
  std::uint8_t number = 0;
  std::vector<std::byte> data;
  bool operator==(const XrealCommand&) const = default;
};
inline constexpr std::uint8_t kXrealStream = 0x19;  ///< data 1: on, 0: off

std::array<std::byte, 64> format_xreal_command(const XrealCommand& command) noexcept;
/// Wrong head, length or checksum: nothing.
std::optional<XrealCommand> parse_xreal_command(std::span<const std::byte> report) noexcept;

/// For Driver over open_hid() of the inertial interface: orientation only.
class XrealProtocol {
 public:
  using Sample = HeadSample;
  Result<void> start(Transport& transport, TimestampNs now);
  Result<void> keep_up(Transport&, TimestampNs) { return {}; }
  bool accept(std::span<const std::byte> report, TimestampNs now);
  std::optional<Sample> newest() { return std::exchange(newest_, std::nullopt); }
  void recentre() noexcept { fusion_.recentre(); }

 private:
  ImuFusion fusion_;
  std::optional<Sample> newest_;
  std::optional<std::uint64_t> last_ns_;
  DeviceTimeline timeline_;
};

}  // namespace dubsar
