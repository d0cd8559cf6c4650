#pragma once
// Oculus Rift DK1 and DK2 over HID: inertial reports and the keep-alive. Facts: OpenHMD/OpenHMD src/drv_oculus_rift.

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "devices/head_tracker/head_sample.h"
#include "devices/head_tracker/imu_fusion.h"
#include "devices/transport/transport.h"

namespace dubsar {

enum class RiftModel { kDk1, kDk2 };

inline constexpr std::uint16_t kRiftVendor = 0x2833, kRiftDk1 = 0x0001, kRiftDk2 = 0x0021,
                               kRiftDk2Late = 0x2021;  ///< a DK2 too

struct RiftReport {
  RiftModel model = RiftModel::kDk1;
  std::uint32_t ticks = 0;     ///< DK1: ms, 16 bits; DK2: us, 32 bits
  int samples_since_last = 0;  ///< may be more than are in the report; then the earlier ones are lost
  int count = 0;               ///< readings in `samples`, at most 3 (DK1) or 2 (DK2)
  std::array<ImuSample, 3> samples{};
};

/// DK1: 62 bytes, or 64 as some kernels and hubs deliver them, report 1; DK2: 64 bytes, report 11. No readings, or
/// another length: nothing.
std::optional<RiftReport> parse_rift(std::span<const std::byte> report) noexcept;
std::vector<std::byte> format_rift(const RiftReport& report);

/// Three signed 21-bit numbers in 8 bytes, big-endian, the lowest bit unused.
std::array<std::int32_t, 3> unpack_rift_vector(std::span<const std::byte, 8> bytes) noexcept;
std::array<std::byte, 8> pack_rift_vector(const std::array<std::int32_t, 3>& values) noexcept;

/// Feature report without which the tracker falls silent after `interval_ms`.
std::array<std::byte, 5> rift_keep_alive(std::uint16_t interval_ms) noexcept;

/// For Driver over open_hid(): orientation only.
class RiftProtocol {
 public:
  using Sample = HeadSample;
  Result<void> start(Transport& transport, TimestampNs now);
  Result<void> keep_up(Transport& transport, TimestampNs now);
  bool accept(std::span<const std::byte> report, TimestampNs now);
  std::optional<Sample> newest() { return std::exchange(newest_, std::nullopt); }
  void recentre() noexcept { fusion_.recentre(); }

 private:
  ImuFusion fusion_;
  std::optional<Sample> newest_;
  TimestampNs keep_alive_due_ = 0;
};

}  // namespace dubsar
