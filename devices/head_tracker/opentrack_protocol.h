#pragma once
// opentrack's "UDP over network" datagrams, which opentrack, AITrack, Tobii_Linux and telephone programs send. Facts:
// opentrack/opentrack tracker-udp, proto-udp, api/plugin-api.hpp.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "devices/head_tracker/head_sample.h"
#include "devices/transport/transport.h"

namespace dubsar {

inline constexpr std::size_t kOpentrackBytes = 48;
inline constexpr std::uint16_t kOpentrackPort = 4242;

/// As on the wire: six native doubles.
struct OpentrackPacket {
  double x_cm = 0, y_cm = 0, z_cm = 0, yaw_deg = 0, pitch_deg = 0, roll_deg = 0;
  bool operator==(const OpentrackPacket&) const = default;
};

/// Exactly 48 bytes, all finite, positions within kHeadBoxM, angles within 180 degrees; otherwise nothing.
std::optional<OpentrackPacket> parse_opentrack(std::span<const std::byte> datagram) noexcept;
std::array<std::byte, kOpentrackBytes> format_opentrack(const OpentrackPacket& packet) noexcept;

/// Which of x, y, z, yaw, pitch, roll are turned round; senders differ.
using OpentrackInvert = std::array<bool, 6>;

/// On the wire yaw counts to the right and pitch downwards; here all turns are right-handed: R_y(yaw) R_x(pitch)
/// R_z(roll).
Pose opentrack_pose(const OpentrackPacket& packet, const OpentrackInvert& invert = {}) noexcept;
OpentrackPacket opentrack_packet(const Pose& pose) noexcept;

/// For Driver over open_udp().
class OpentrackProtocol {
 public:
  using Sample = HeadSample;
  explicit OpentrackProtocol(const OpentrackInvert& invert = {}) : invert_(invert) {}
  Result<void> start(Transport&, TimestampNs) {
    gate_.reset();
    return {};
  }
  Result<void> keep_up(Transport&, TimestampNs) { return {}; }
  bool accept(std::span<const std::byte> datagram, TimestampNs now);
  std::optional<Sample> newest() { return std::exchange(newest_, std::nullopt); }

 private:
  OpentrackInvert invert_;
  HeadGate gate_;
  std::optional<Sample> newest_;
};

}  // namespace dubsar
