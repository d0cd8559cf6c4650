#include "devices/head_tracker/xreal_protocol.h"

#include <algorithm>
#include <cmath>

#include "core/base/numbers/angle.h"
#include "core/base/numbers/bytes.h"
#include "devices/head_tracker/byte_text.h"

namespace dubsar {
namespace {

constexpr std::string_view kByNetwork =
    "its poses come over a network of its own, which XRLinuxDriver speaks and this program does not";
constexpr std::string_view kNotKnown = "the number of its inertial interface is not known here";
constexpr std::array<XrealProduct, 12> kProducts{{{0x0424, "XREAL Air", 3, {}},
                                                  {0x0428, "XREAL Air 2", 3, {}},
                                                  {0x0432, "XREAL Air 2 Pro", 3, {}},
                                                  {0x0426, "XREAL Air 2 Ultra", 2, {}},
                                                  {0x0435, "XREAL One Pro", -1, kByNetwork},
                                                  {0x0436, "XREAL One Pro", -1, kByNetwork},
                                                  {0x0437, "XREAL One", -1, kByNetwork},
                                                  {0x0438, "XREAL One", -1, kByNetwork},
                                                  {0x043d, "XREAL 1S", -1, kByNetwork},
                                                  {0x043e, "XREAL 1S", -1, kByNetwork},
                                                  {0x0440, "XREAL xbx a01", -1, kNotKnown},
                                                  {0x0442, "XREAL xbx a01+", -1, kNotKnown}}};

constexpr double kMaxTurn_deg_s = 4000.0, kMaxForce_g = 64.0;
constexpr std::size_t kReportBytes = 64, kGyroAt = 12, kAccelAt = 27;
constexpr std::size_t kCommandDataAt = 8, kCommandMaxData = kReportBytes - kCommandDataAt;

/// CRC-32 of IEEE 802.3 (reflected, polynomial EDB88320).
std::uint32_t crc32(std::span<const std::byte> bytes) noexcept {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320U & (0U - (crc & 1U)));
  }
  return ~crc;
}

double signed_24(ByteReader& reader) {
  std::uint32_t value = 0;
  for (int shift = 8; shift <= 24; shift += 8) value |= std::uint32_t{reader.little<std::uint8_t>()} << shift;
  return static_cast<double>(static_cast<std::int32_t>(value) >> 8);
}

/// Multiplier, divisor and three numbers; nothing when the divisor is 0 or a value is beyond `limit`.
std::optional<glm::dvec3> scaled_vector(ByteReader& reader, double limit) {
  const double multiplier = reader.little<std::uint16_t>();
  const double divisor = reader.little<std::uint32_t>();
  if (divisor == 0.0) return std::nullopt;
  glm::dvec3 v;
  for (int i = 0; i < 3; ++i) {
    v[i] = signed_24(reader) * multiplier / divisor;
    if (std::abs(v[i]) > limit) return std::nullopt;
  }
  return v;
}

/// The sensor's axes to the head's.
glm::dvec3 head_from_sensor(const glm::dvec3& v) { return {-v.x, v.z, v.y}; }

template <class T>
void put(std::span<std::byte> out, std::size_t at, T value, std::size_t bytes = sizeof(T)) {
  for (std::size_t i = 0; i < bytes; ++i)
    out[at + i] = static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU);
}

void put_vector(std::span<std::byte> out, std::size_t at, const glm::dvec3& sensor, std::uint16_t full_scale) {
  constexpr std::uint32_t kDivisor = 1U << 23;
  put(out, at, full_scale);
  put(out, at + 2, kDivisor);
  for (int i = 0; i < 3; ++i) {
    const double raw = std::clamp(sensor[i] * kDivisor / full_scale, -8388608.0, 8388607.0);
    put(out, at + 6 + 3 * static_cast<std::size_t>(i), std::lround(raw), 3);
  }
}

}  // namespace

std::span<const XrealProduct> xreal_products() noexcept { return kProducts; }

std::optional<XrealReport> parse_xreal(std::span<const std::byte> report) noexcept {
  if (report.size() != kReportBytes || report[0] != std::byte{1} || report[1] != std::byte{2}) return std::nullopt;
  ByteReader reader(as_text(report));
  reader.take(4);  // head and temperature
  XrealReport parsed;
  parsed.time_ns = reader.little<std::uint64_t>();
  const auto turn_deg_s = scaled_vector(reader, kMaxTurn_deg_s);
  if (!turn_deg_s) return std::nullopt;
  const auto force_g = scaled_vector(reader, kMaxForce_g);
  if (!force_g) return std::nullopt;
  parsed.sample.turn_rate_rad_s = head_from_sensor(*turn_deg_s) * kRadPerDeg;
  parsed.sample.acceleration_m_s2 = head_from_sensor(*force_g) * kStandardGravity;
  return parsed;
}

std::array<std::byte, 64> format_xreal(const XrealReport& report) noexcept {
  std::array<std::byte, 64> bytes{};
  bytes[0] = std::byte{1};
  bytes[1] = std::byte{2};
  put(std::span(bytes), 4, report.time_ns);
  // the swap of axes is its own inverse
  put_vector(bytes, kGyroAt, head_from_sensor(report.sample.turn_rate_rad_s / kRadPerDeg), 2000);
  put_vector(bytes, kAccelAt, head_from_sensor(report.sample.acceleration_m_s2 / kStandardGravity), 16);
  return bytes;
}

std::array<std::byte, 64> format_xreal_command(const XrealCommand& command) noexcept {
  std::array<std::byte, 64> bytes{};
  const std::size_t data = std::min(command.data.size(), kCommandMaxData);
  bytes[0] = std::byte{0xAA};
  put(std::span(bytes), 5, static_cast<std::uint16_t>(data + 3));
  bytes[7] = static_cast<std::byte>(command.number);
  std::copy_n(command.data.begin(), data, bytes.begin() + kCommandDataAt);
  put(std::span(bytes), 1, crc32(std::span(bytes).subspan(5, data + 3)));
  return bytes;
}

std::optional<XrealCommand> parse_xreal_command(std::span<const std::byte> report) noexcept {
  if (report.size() != kReportBytes || report[0] != std::byte{0xAA}) return std::nullopt;
  ByteReader reader(as_text(report.subspan(1)));
  const auto checksum = reader.little<std::uint32_t>();
  const std::size_t length = reader.little<std::uint16_t>();
  if (length < 3 || length > kCommandMaxData + 3) return std::nullopt;
  if (crc32(report.subspan(5, length)) != checksum) return std::nullopt;
  const auto data = report.subspan(kCommandDataAt, length - 3);
  return XrealCommand{std::to_integer<std::uint8_t>(report[7]), {data.begin(), data.end()}};
}

Result<void> XrealProtocol::start(Transport& transport, TimestampNs) {
  fusion_.reset();
  newest_.reset();
  last_ns_.reset();
  timeline_ = {};
  return transport.write(format_xreal_command({kXrealStream, {std::byte{1}}}));
}

bool XrealProtocol::accept(std::span<const std::byte> report, TimestampNs now) {
  const auto parsed = parse_xreal(report);
  if (!parsed) return parse_xreal_command(report).has_value();
  const bool in_order = !last_ns_ || parsed->time_ns > *last_ns_;
  const double dt_s = last_ns_ && in_order ? 1e-9 * static_cast<double>(parsed->time_ns - *last_ns_) : 0.0;
  last_ns_ = parsed->time_ns;
  fusion_.update(parsed->sample, dt_s);
  const TimestampNs time = timeline_.host_time(static_cast<TimestampNs>(parsed->time_ns & 0x7FFFFFFFFFFFFFFFU), now);
  newest_ = HeadSample{time, {{}, fusion_.world_from_head()}, false, true};
  return true;
}

}  // namespace dubsar
