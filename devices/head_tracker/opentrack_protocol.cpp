#include "devices/head_tracker/opentrack_protocol.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace dubsar {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;
static_assert(sizeof(OpentrackPacket) == kOpentrackBytes);

}  // namespace

std::optional<OpentrackPacket> parse_opentrack(std::span<const std::byte> datagram) noexcept {
  if (datagram.size() != kOpentrackBytes) return std::nullopt;
  std::array<double, 6> v;
  std::memcpy(v.data(), datagram.data(), sizeof v);
  for (std::size_t i = 0; i < 6; ++i)
    if (!(std::abs(v[i]) <= (i < 3 ? 100.0 * kHeadBoxM : 180.0))) return std::nullopt;  // NaN fails too
  return OpentrackPacket{v[0], v[1], v[2], v[3], v[4], v[5]};
}

std::array<std::byte, kOpentrackBytes> format_opentrack(const OpentrackPacket& packet) noexcept {
  std::array<std::byte, kOpentrackBytes> bytes;
  std::memcpy(bytes.data(), &packet, sizeof packet);
  return bytes;
}

Pose opentrack_pose(const OpentrackPacket& packet, const OpentrackInvert& invert) noexcept {
  const auto sign = [&](std::size_t i) { return invert[i] ? -1.0 : 1.0; };
  const double yaw = -sign(3) * packet.yaw_deg * kDeg, pitch = -sign(4) * packet.pitch_deg * kDeg;
  const double roll = sign(5) * packet.roll_deg * kDeg;
  return {{sign(0) * packet.x_cm * 0.01, sign(1) * packet.y_cm * 0.01, sign(2) * packet.z_cm * 0.01},
          glm::angleAxis(yaw, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch, glm::dvec3(1, 0, 0)) *
              glm::angleAxis(roll, glm::dvec3(0, 0, 1))};
}

OpentrackPacket opentrack_packet(const Pose& pose) noexcept {
  const glm::dquat& q = pose.rotation;
  // matrix of R_y R_x R_z: m[1][2] = -sin(pitch) in row 1, column 2
  const double pitch = std::asin(std::clamp(2.0 * (q.w * q.x - q.y * q.z), -1.0, 1.0));
  const double yaw = std::atan2(2.0 * (q.x * q.z + q.w * q.y), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
  const double roll = std::atan2(2.0 * (q.x * q.y + q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z));
  return {pose.position_m.x * 100.0,
          pose.position_m.y * 100.0,
          pose.position_m.z * 100.0,
          -yaw / kDeg,
          -pitch / kDeg,
          roll / kDeg};
}

bool OpentrackProtocol::accept(std::span<const std::byte> datagram, TimestampNs now) {
  const auto packet = parse_opentrack(datagram);
  if (!packet) return false;
  const auto passed = gate_.pass({now, opentrack_pose(*packet, invert_), true, true});
  if (passed) newest_ = passed;
  return passed.has_value();
}

}  // namespace dubsar
