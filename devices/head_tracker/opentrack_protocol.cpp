#include "devices/head_tracker/opentrack_protocol.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/numbers/angle.h"

namespace dubsar {
namespace {

static_assert(sizeof(OpentrackPacket) == kOpentrackBytes);

/// What x, y, z, yaw, pitch and roll on the wire are multiplied with to be ours: x right, y up, z back, right-handed
/// turns.
constexpr std::array<double, 6> kOpentrackSigns{-1, 1, 1, -1, 1, 1}, kXrLinuxSigns{1, 1, 1, 1, -1, -1};

constexpr const std::array<double, 6>& signs_of(OpentrackSender sender) {
  return sender == OpentrackSender::kXrLinux ? kXrLinuxSigns : kOpentrackSigns;
}

}  // namespace

OpentrackSender opentrack_sender(std::size_t datagram_bytes) noexcept {
  return datagram_bytes == kXrLinuxBytes ? OpentrackSender::kXrLinux : OpentrackSender::kOpentrack;
}

Result<std::optional<OpentrackSender>> parse_opentrack_sender(std::string_view name) {
  if (name.empty()) return std::nullopt;
  if (name == "opentrack") return OpentrackSender::kOpentrack;
  if (name == "xrlinux") return OpentrackSender::kXrLinux;
  return fail(ErrorKind::kUsage, "opentrack: sender \"{}\" found, expected opentrack or xrlinux", name);
}

std::optional<OpentrackPacket> parse_opentrack(std::span<const std::byte> datagram) noexcept {
  if (datagram.size() < kOpentrackBytes) return std::nullopt;
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

Pose opentrack_pose(const OpentrackPacket& packet, OpentrackSender sender, const OpentrackInvert& invert) noexcept {
  std::array<double, 6> v{packet.x_cm, packet.y_cm, packet.z_cm, packet.yaw_deg, packet.pitch_deg, packet.roll_deg};
  for (std::size_t i = 0; i < v.size(); ++i) v[i] *= signs_of(sender)[i] * (invert[i] ? -1.0 : 1.0);
  return {glm::dvec3(v[0], v[1], v[2]) * 0.01, glm::angleAxis(v[3] * kRadPerDeg, glm::dvec3(0, 1, 0)) *
                                                   glm::angleAxis(v[4] * kRadPerDeg, glm::dvec3(1, 0, 0)) *
                                                   glm::angleAxis(v[5] * kRadPerDeg, glm::dvec3(0, 0, 1))};
}

OpentrackPacket opentrack_packet(const Pose& pose, OpentrackSender sender) noexcept {
  const glm::dquat& q = pose.rotation;
  // matrix of R_y R_x R_z: m[1][2] = -sin(pitch) in row 1, column 2
  const double pitch = std::asin(std::clamp(2.0 * (q.w * q.x - q.y * q.z), -1.0, 1.0));
  const double yaw = std::atan2(2.0 * (q.x * q.z + q.w * q.y), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
  const double roll = std::atan2(2.0 * (q.x * q.y + q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z));
  const std::array<double, 6>& sign = signs_of(sender);
  return {sign[0] * pose.position_m.x * 100.0, sign[1] * pose.position_m.y * 100.0, sign[2] * pose.position_m.z * 100.0,
          sign[3] * yaw / kRadPerDeg,          sign[4] * pitch / kRadPerDeg,        sign[5] * roll / kRadPerDeg};
}

bool OpentrackProtocol::accept(std::span<const std::byte> datagram, TimestampNs now) {
  const auto packet = parse_opentrack(datagram);
  if (!packet) return false;
  const OpentrackSender sender = sender_.value_or(opentrack_sender(datagram.size()));
  heard_xrlinux_ = !sender_ && sender == OpentrackSender::kXrLinux;
  // glasses that know no place say 0, which is no place either
  const bool placed =
      sender != OpentrackSender::kXrLinux || packet->x_cm != 0.0 || packet->y_cm != 0.0 || packet->z_cm != 0.0;
  const auto passed = gate_.pass({now, opentrack_pose(*packet, sender, invert_), placed, true});
  if (passed) newest_ = passed;
  return passed.has_value();
}

std::string OpentrackProtocol::note() const {
  if (dropped_.count > 0) {
    const std::string what = dropped_.last_bytes < kOpentrackBytes
                                 ? fmt::format(
                                       "{} bytes came, {} expected (six doubles, as opentrack's \"UDP over "
                                       "network\" sends them)",
                                       dropped_.last_bytes, kOpentrackBytes)
                                 : "places or angles came that no head can have";
    return fmt::format("opentrack: {}; {} such datagram{} left out", what, dropped_.count,
                       dropped_.count == 1 ? " was" : "s were");
  }
  if (!heard_xrlinux_) return {};
  return "opentrack: datagrams of 52 bytes are XRLinuxDriver's: x counts to the right and yaw to the left "
         "(sender=opentrack: as opentrack does)";
}

}  // namespace dubsar
