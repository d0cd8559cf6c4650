#pragma once
// VRPN's messages over TCP, and the client's side: poses of "vrpn_Tracker Pos_Quat". Facts: vrpn/vrpn
// vrpn_Connection.C, checked against bytes of its own server and client 07.38.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "devices/head_tracker/head_sample.h"
#include "devices/transport/device_timeline.h"
#include "devices/transport/transport.h"

namespace dubsar {

inline constexpr std::uint16_t kVrpnPort = 3883;
inline constexpr std::size_t kVrpnCookieBytes = 24;
inline constexpr std::size_t kVrpnMaxMessageBytes = 65536;
inline constexpr std::int32_t kVrpnSenderName = -1, kVrpnTypeName = -2;  ///< types of the messages that give names
inline constexpr std::size_t kVrpnMaxNames = 2000;                       ///< vrpn's own limit

/// What both sides send first. The part up to the last full stop (the major version) must agree.
std::array<std::byte, kVrpnCookieBytes> vrpn_cookie();
bool vrpn_cookie_fits(std::span<const std::byte> cookie) noexcept;

struct VrpnMessage {
  std::uint32_t seconds = 0, microseconds = 0;
  std::int32_t sender = 0;
  std::int32_t type = 0;  ///< negative: system messages (-1 a sender's name, -2 a type's name, -5 goodbye)
  std::vector<std::byte> payload;
  bool operator==(const VrpnMessage&) const = default;
};

std::vector<std::byte> format_vrpn(const VrpnMessage& message);
/// Gives a number a name: type -1 for senders, -2 for message types.
VrpnMessage vrpn_name_message(std::int32_t type, std::int32_t number, std::string_view name);
VrpnMessage vrpn_pose_message(std::int32_t sender, std::int32_t type, std::int32_t sensor, const Pose& pose);

/// Cuts a byte stream into messages. A wrong cookie, or a length below 24 or above kVrpnMaxMessageBytes, ends it for
/// good.
class VrpnStream {
 public:
  void feed(std::span<const std::byte> bytes);
  std::optional<VrpnMessage> next();
  bool broken() const noexcept { return broken_; }
  bool greeted() const noexcept { return greeted_ && !broken_; }  ///< the other side's cookie has come, and fits

 private:
  std::vector<std::byte> pending_;
  std::size_t begin_ = 0;  ///< of what has not been used in pending_
  bool greeted_ = false, broken_ = false;
};

struct VrpnChoice {
  std::string tracker;      ///< the sender's name, such as "Tracker0"; empty: the first that sends poses
  std::int32_t sensor = 0;  ///< which of its sensors is the head
};

/// For Driver over open_tcp_stream(). Poses are in the server's frame, in metres, whose origin may lie anywhere in a
/// hall.
class VrpnProtocol {
 public:
  using Sample = HeadSample;
  explicit VrpnProtocol(VrpnChoice choice = {}) : choice_(std::move(choice)) {}
  Result<void> start(Transport& transport, TimestampNs now);
  /// kUnavailable when the stream is broken or the server has said goodbye.
  Result<void> keep_up(Transport& transport, TimestampNs now);
  /// False when a message in these bytes was invalid.
  bool accept(std::span<const std::byte> bytes, TimestampNs now);
  std::optional<Sample> newest() { return std::exchange(newest_, std::nullopt); }
  /// While the wished tracker or sensor has not been heard: which have. Empty when it has, or nothing was heard yet.
  std::string note() const;

 private:
  static constexpr std::size_t kMaxHeard = 64;
  bool handle(const VrpnMessage& message, TimestampNs now);
  VrpnChoice choice_;
  VrpnStream stream_;
  std::map<std::int32_t, std::string> senders_, types_;
  std::optional<std::int32_t> first_sender_;
  std::map<std::string, std::set<std::int32_t>> heard_;  ///< sensors by tracker, at most kMaxHeard of each
  bool goodbye_ = false, found_ = false;
  HeadGate gate_{kHallM};
  DeviceTimeline timeline_;
  std::optional<Sample> newest_;
};

}  // namespace dubsar
