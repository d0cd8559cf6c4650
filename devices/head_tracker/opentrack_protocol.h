#pragma once
// opentrack's "UDP over network" datagrams, which opentrack, AITrack, Tobii_Linux, telephone programs and XRLinuxDriver
// send. Facts: opentrack/opentrack tracker-udp, proto-udp, api/plugin-api.hpp, for the signs tracker-steamvr,
// tracker-tobii and proto-flightgear; wheaney/XRLinuxDriver src/plugins/opentrack_source.c.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "devices/head_tracker/head_sample.h"
#include "devices/transport/transport.h"

namespace dubsar {

inline constexpr std::size_t kOpentrackBytes = 48;
inline constexpr std::size_t kXrLinuxBytes = 52;  ///< the same six doubles and a 32-bit frame number
inline constexpr std::uint16_t kOpentrackPort = 4242;

/// Who counts how. opentrack: x to the user's left, y up, z back, yaw to the right, pitch up, roll to the left.
/// XRLinuxDriver, for glasses: x right, y up, z back, yaw to the left, pitch down, roll to the right; without a place
/// x, y and z are 0.
enum class OpentrackSender { kOpentrack, kXrLinux };
/// XRLinuxDriver's datagrams are told by their length.
OpentrackSender opentrack_sender(std::size_t datagram_bytes) noexcept;
/// "opentrack", "xrlinux"; "" leaves it to the length of the datagrams. kUsage otherwise.
Result<std::optional<OpentrackSender>> parse_opentrack_sender(std::string_view name);

/// As on the wire: six native doubles.
struct OpentrackPacket {
  double x_cm = 0, y_cm = 0, z_cm = 0, yaw_deg = 0, pitch_deg = 0, roll_deg = 0;
  bool operator==(const OpentrackPacket&) const = default;
};

/// At least 48 bytes, of which the first 48 count, all finite, positions within kHeadBoxM, angles within 180 degrees;
/// otherwise nothing.
std::optional<OpentrackPacket> parse_opentrack(std::span<const std::byte> datagram) noexcept;
std::array<std::byte, kOpentrackBytes> format_opentrack(const OpentrackPacket& packet) noexcept;

/// Which of x, y, z, yaw, pitch, roll are turned round; senders differ.
using OpentrackInvert = std::array<bool, 6>;

/// Here all turns are right-handed, R_y(yaw) R_x(pitch) R_z(roll), and x is to the user's right.
Pose opentrack_pose(const OpentrackPacket& packet, OpentrackSender sender = OpentrackSender::kOpentrack,
                    const OpentrackInvert& invert = {}) noexcept;
OpentrackPacket opentrack_packet(const Pose& pose, OpentrackSender sender = OpentrackSender::kOpentrack) noexcept;

/// For Driver over open_udp().
class OpentrackProtocol {
 public:
  using Sample = HeadSample;
  /// Without `sender` the length of each datagram tells it.
  explicit OpentrackProtocol(const OpentrackInvert& invert = {}, std::optional<OpentrackSender> sender = {})
      : invert_(invert), sender_(sender) {}
  Result<void> start(Transport&, TimestampNs) {
    gate_.reset();
    heard_xrlinux_ = false;
    dropped_ = {};
    return {};
  }
  Result<void> keep_up(Transport&, TimestampNs) { return {}; }
  bool accept(std::span<const std::byte> datagram, TimestampNs now);
  std::optional<Sample> newest() { return std::exchange(newest_, std::nullopt); }
  /// Datagrams that the transport refused (parse_opentrack()).
  void hear_of_dropped(const DroppedInput& dropped) noexcept { dropped_ = dropped; }
  /// One sentence when datagrams came that are none of opentrack's, or when the sender was recognised as XRLinuxDriver
  /// without having been named.
  std::string note() const;

 private:
  OpentrackInvert invert_;
  std::optional<OpentrackSender> sender_;
  bool heard_xrlinux_ = false;
  DroppedInput dropped_;
  HeadGate gate_;
  std::optional<Sample> newest_;
};

}  // namespace dubsar
