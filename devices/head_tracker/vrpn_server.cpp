#include "devices/head_tracker/vrpn_server.h"

#include <charconv>

#include "devices/head_tracker/byte_text.h"

namespace dubsar {
namespace {

constexpr std::int32_t kTracker = 0, kPosQuat = 0, kPong = 1;  // our numbers
constexpr std::size_t kMaxCallBytes = 256;

void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void set_time(VrpnMessage& message, TimestampNs time) {
  message.seconds = static_cast<std::uint32_t>(time / 1'000'000'000);
  message.microseconds = static_cast<std::uint32_t>(time / 1000 % 1'000'000);
}

}  // namespace

std::optional<std::uint16_t> parse_vrpn_call(std::span<const std::byte> datagram) noexcept {
  std::string_view text = as_text(datagram);
  if (text.size() > kMaxCallBytes || text.empty() || text.back() != '\0') return std::nullopt;
  text.remove_suffix(1);
  const std::size_t space = text.find(' ');
  if (space == 0 || space == std::string_view::npos) return std::nullopt;
  const std::string_view number = text.substr(space + 1);
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), port);
  if (error != std::errc() || end != number.data() + number.size() || port == 0) return std::nullopt;
  return port;
}

Result<std::vector<std::byte>> VrpnServerSide::accept(std::span<const std::byte> bytes) {
  std::vector<std::byte> answer;
  stream_.feed(bytes);
  auto message = stream_.next();
  if (stream_.greeted() && !answered_) {
    answered_ = true;
    append(answer, vrpn_cookie());
    append(answer, format_vrpn(vrpn_name_message(kVrpnSenderName, kTracker, tracker_)));
    append(answer, format_vrpn(vrpn_name_message(kVrpnTypeName, kPosQuat, "vrpn_Tracker Pos_Quat")));
    append(answer, format_vrpn(vrpn_name_message(kVrpnTypeName, kPong, "vrpn_Base pong_message")));
  }
  for (; message; message = stream_.next()) {
    if (message->type == kVrpnSenderName || message->type == kVrpnTypeName) {
      auto& names = message->type == kVrpnSenderName ? senders_ : types_;
      if (message->payload.size() <= sizeof(std::uint32_t) || names.size() >= kVrpnMaxNames) continue;
      const std::string_view name = as_text(std::span(message->payload).subspan(sizeof(std::uint32_t)));
      names[message->sender] = name.substr(0, name.find('\0'));
      continue;
    }
    const auto type = types_.find(message->type);
    const auto sender = senders_.find(message->sender);
    if (type == types_.end() || type->second != "vrpn_Base ping_message") continue;
    if (sender == senders_.end() || sender->second != tracker_) continue;
    VrpnMessage pong;
    pong.sender = kTracker;
    pong.type = kPong;
    pong.seconds = message->seconds;
    pong.microseconds = message->microseconds;
    append(answer, format_vrpn(pong));
  }
  if (stream_.broken())
    return fail(ErrorKind::kBadData, "vrpn: the client does not speak version 07, or its stream is damaged");
  return answer;
}

std::vector<std::byte> VrpnServerSide::pose(TimestampNs time, const Pose& pose) const {
  if (!answered_) return {};
  VrpnMessage message = vrpn_pose_message(kTracker, kPosQuat, 0, pose);
  set_time(message, time);
  return format_vrpn(message);
}

}  // namespace dubsar
