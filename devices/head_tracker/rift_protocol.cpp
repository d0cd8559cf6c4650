#include "devices/head_tracker/rift_protocol.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

constexpr double kScale = 1e-4;  // m/s^2 and rad/s per unit
constexpr double kSamplePeriod_s = 1e-3;
constexpr std::uint16_t kKeepAliveMs = 10'000;
constexpr TimestampNs kKeepAliveNs = 9'800'000'000;  // a little early, so that a slow poll does not end the stream

struct Layout {
  std::uint8_t id;
  std::size_t bytes, count_at, ticks_at, samples_at;
  int max_samples;
};
constexpr Layout kDk1Layout{1, 62, 1, 2, 8, 3};
constexpr Layout kDk2Layout{11, 64, 3, 8, 12, 2};

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<std::uint32_t>(bytes[at]);
}

glm::dvec3 scaled(const std::array<std::int32_t, 3>& v) { return glm::dvec3(v[0], v[1], v[2]) * kScale; }

std::array<std::int32_t, 3> unscaled(const glm::dvec3& v) {
  std::array<std::int32_t, 3> out{};
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i)] =
        static_cast<std::int32_t>(std::lround(std::clamp(v[i] / kScale, -1048576.0, 1048575.0)));
  return out;
}

}  // namespace

std::array<std::int32_t, 3> unpack_rift_vector(std::span<const std::byte, 8> bytes) noexcept {
  std::uint64_t all = 0;
  for (const std::byte byte : bytes) all = all << 8 | std::to_integer<std::uint64_t>(byte);
  std::array<std::int32_t, 3> values{};
  for (std::size_t i = 0; i < 3; ++i)  // each number to the top, then down with its sign
    values[i] = static_cast<std::int32_t>(static_cast<std::int64_t>(all << (21 * i)) >> 43);
  return values;
}

std::array<std::byte, 8> pack_rift_vector(const std::array<std::int32_t, 3>& values) noexcept {
  std::uint64_t all = 0;
  for (const std::int32_t value : values) all = all << 21 | (static_cast<std::uint64_t>(value) & 0x1FFFFFU);
  all <<= 1;
  std::array<std::byte, 8> bytes{};
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::byte>(all >> (56 - 8 * i) & 0xFFU);
  return bytes;
}

std::optional<RiftReport> parse_rift(std::span<const std::byte> report) noexcept {
  RiftReport parsed;
  const Layout* layout = nullptr;
  const bool dk1_size = report.size() == kDk1Layout.bytes || report.size() == kDk2Layout.bytes;
  if (dk1_size && byte_at(report, 0) == kDk1Layout.id) {
    layout = &kDk1Layout;
    parsed.model = RiftModel::kDk1;
    parsed.ticks = byte_at(report, 2) | byte_at(report, 3) << 8;
  } else if (report.size() == kDk2Layout.bytes && byte_at(report, 0) == kDk2Layout.id) {
    layout = &kDk2Layout;
    parsed.model = RiftModel::kDk2;
    for (std::size_t i = 0; i < 4; ++i) parsed.ticks |= byte_at(report, kDk2Layout.ticks_at + i) << (8 * i);
  } else {
    return std::nullopt;
  }
  parsed.samples_since_last = static_cast<int>(byte_at(report, layout->count_at));
  if (parsed.samples_since_last == 0) return std::nullopt;
  parsed.count = std::min(parsed.samples_since_last, layout->max_samples);
  for (std::size_t i = 0; i < static_cast<std::size_t>(parsed.count); ++i) {
    const auto pair = report.subspan(layout->samples_at + 16 * i, 16);
    parsed.samples[i].acceleration_m_s2 = scaled(unpack_rift_vector(pair.first<8>()));
    parsed.samples[i].turn_rate_rad_s = scaled(unpack_rift_vector(pair.last<8>()));
  }
  return parsed;
}

std::vector<std::byte> format_rift(const RiftReport& report) {
  const Layout& layout = report.model == RiftModel::kDk1 ? kDk1Layout : kDk2Layout;
  std::vector<std::byte> bytes(layout.bytes);
  bytes[0] = static_cast<std::byte>(layout.id);
  bytes[layout.count_at] = static_cast<std::byte>(report.samples_since_last);
  for (std::size_t i = 0; i < (report.model == RiftModel::kDk1 ? 2U : 4U); ++i)
    bytes[layout.ticks_at + i] = static_cast<std::byte>(report.ticks >> (8 * i) & 0xFFU);
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::min(report.count, layout.max_samples)); ++i) {
    const auto force = pack_rift_vector(unscaled(report.samples[i].acceleration_m_s2));
    const auto turn = pack_rift_vector(unscaled(report.samples[i].turn_rate_rad_s));
    std::copy(force.begin(), force.end(), bytes.begin() + static_cast<std::ptrdiff_t>(layout.samples_at + 16 * i));
    std::copy(turn.begin(), turn.end(), bytes.begin() + static_cast<std::ptrdiff_t>(layout.samples_at + 16 * i + 8));
  }
  return bytes;
}

std::array<std::byte, 5> rift_keep_alive(std::uint16_t interval_ms) noexcept {
  return {std::byte{8}, std::byte{0}, std::byte{0}, static_cast<std::byte>(interval_ms & 0xFFU),
          static_cast<std::byte>(interval_ms >> 8)};
}

Result<void> RiftProtocol::start(Transport& transport, TimestampNs now) {
  fusion_.reset();
  newest_.reset();
  keep_alive_due_ = now;
  return keep_up(transport, now);
}

Result<void> RiftProtocol::keep_up(Transport& transport, TimestampNs now) {
  if (now < keep_alive_due_) return {};
  keep_alive_due_ = now + kKeepAliveNs;
  return transport.set_feature(rift_keep_alive(kKeepAliveMs));
}

bool RiftProtocol::accept(std::span<const std::byte> report, TimestampNs now) {
  const auto parsed = parse_rift(report);
  if (!parsed) return false;
  // readings that did not fit into the report are made up for by the first one
  double dt_s = kSamplePeriod_s * (1 + parsed->samples_since_last - parsed->count);
  for (int i = 0; i < parsed->count; ++i) {
    fusion_.update(parsed->samples[static_cast<std::size_t>(i)], dt_s);
    dt_s = kSamplePeriod_s;
  }
  newest_ = HeadSample{now, {{}, fusion_.world_from_head()}, false, true};
  return true;
}

}  // namespace dubsar
