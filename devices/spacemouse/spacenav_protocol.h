#pragma once
// The spacenavd daemon's socket: events for programs that share one SpaceMouse. Facts: FreeSpacenav/libspnav (protocol
// version 1) and FreeSpacenav/spacenavd src/proto.h, checked against Debian's libspnav 1.0.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "devices/spacemouse/spacemouse_protocol.h"

namespace dubsar {

inline constexpr const char* kSpacenavSocket = "/var/run/spnav.sock";

/// Full deflection: the daemon scales what the kernel says of an axis to +-500 (src/dev_usb_linux.c); the sensitivity
/// that its user has set comes on top.
inline constexpr int kSpacenavFullScale = 500;
/// Longest time that a deflection holds without a word from the daemon, which tells every change of a SpaceMouse's
/// axes.
inline constexpr TimestampNs kSpacenavHoldsNs = 1'000'000'000;

struct SpacenavEvent {
  /// kOther: settings and raw input that other programs ask for.
  enum class Kind : std::int32_t { kMotion = 0, kPress = 1, kRelease = 2, kDevice = 3, kOther = 4 };
  Kind kind = Kind::kMotion;
  glm::ivec3 translation{0}, rotation{0};  ///< daemon axes: x right, y up, z away
  std::int32_t period_ms = 0;
  std::int32_t button = 0;
  bool removed = false;  ///< kDevice: it was unplugged, not plugged in
  bool operator==(const SpacenavEvent&) const = default;
};

inline constexpr std::size_t kSpacenavEventBytes = 32;
inline constexpr std::int32_t kSpacenavHello = 0x7faa5500;  ///< plus the protocol version in the low byte
inline constexpr std::int32_t kSpacenavTag = 0x7faa0000;    ///< of requests and their answers, in the upper half

/// One 32-byte event, native byte order. Answers to requests, settings and raw input are kOther. Unknown kinds, values
/// beyond +-4096, buttons beyond 0..255: nothing.
std::optional<SpacenavEvent> parse_spacenav(std::span<const std::byte> event) noexcept;
std::vector<std::byte> format_spacenav(const SpacenavEvent& event);
/// The greeting: sent by the client with the version it wants, answered with the version it gets.
std::vector<std::byte> spacenav_hello(std::uint8_t version);

/// For Driver over open_unix_stream(): finds the events in the byte stream, with or without the answer to the greeting.
class SpacenavProtocol {
 public:
  using Sample = SpaceMouseSample;
  Result<void> start(Transport& transport, TimestampNs now);
  /// A deflection ends when the daemon has been silent for kSpacenavHoldsNs.
  Result<void> keep_up(Transport&, TimestampNs now);
  /// False when any event in these bytes was invalid.
  bool accept(std::span<const std::byte> bytes, TimestampNs now);
  std::optional<Sample> newest();

 private:
  void apply(const SpacenavEvent& event, TimestampNs now);
  void let_go(TimestampNs now);
  Sample sample_;
  TimestampNs moved_ = 0;  ///< when the last motion came
  bool changed_ = false;
  bool greeted_ = false;  ///< the first four bytes have been looked at
  std::array<std::byte, kSpacenavEventBytes> pending_{};
  std::size_t pending_bytes_ = 0;
};

}  // namespace dubsar
