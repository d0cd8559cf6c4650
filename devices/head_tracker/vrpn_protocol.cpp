#include "devices/head_tracker/vrpn_protocol.h"

#include <algorithm>
#include <cstring>

#include "core/base/numbers/bytes.h"
#include "devices/head_tracker/byte_text.h"

namespace dubsar {
namespace {

constexpr std::string_view kCookie = "vrpn: ver. 07.38  0";
constexpr std::size_t kHeaderBytes = 24;
constexpr std::size_t kPosQuatBytes = 64;
constexpr std::int32_t kGoodbye = -5;
constexpr std::size_t kMaxNameBytes = 100;  // vrpn's own limit

template <class T>
void append_big(std::vector<std::byte>& out, T value) {
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  for (std::size_t i = sizeof(T); i > 0; --i) out.push_back(bytes[i - 1]);
}

constexpr std::size_t padded(std::size_t bytes) { return (bytes + 7) / 8 * 8; }

}  // namespace

std::array<std::byte, kVrpnCookieBytes> vrpn_cookie() {
  std::array<std::byte, kVrpnCookieBytes> cookie{};
  std::memcpy(cookie.data(), kCookie.data(), kCookie.size());
  return cookie;
}

bool vrpn_cookie_fits(std::span<const std::byte> cookie) noexcept {
  const std::string_view major = kCookie.substr(0, kCookie.rfind('.'));
  return cookie.size() == kVrpnCookieBytes && as_text(cookie).starts_with(major);
}

std::vector<std::byte> format_vrpn(const VrpnMessage& message) {
  std::vector<std::byte> out;
  out.reserve(padded(kHeaderBytes + message.payload.size()));
  append_big(out, static_cast<std::uint32_t>(kHeaderBytes + message.payload.size()));
  append_big(out, message.seconds);
  append_big(out, message.microseconds);
  append_big(out, message.sender);
  append_big(out, message.type);
  append_big(out, std::uint32_t{0});
  out.insert(out.end(), message.payload.begin(), message.payload.end());
  out.resize(padded(out.size()));
  return out;
}

VrpnMessage vrpn_name_message(std::int32_t type, std::int32_t number, std::string_view name) {
  VrpnMessage message;
  message.sender = number;
  message.type = type;
  message.payload.reserve(sizeof(std::uint32_t) + name.size() + 1);
  append_big(message.payload, static_cast<std::uint32_t>(name.size() + 1));
  const auto bytes = as_bytes(name);
  message.payload.insert(message.payload.end(), bytes.begin(), bytes.end());
  message.payload.push_back(std::byte{0});
  return message;
}

VrpnMessage vrpn_pose_message(std::int32_t sender, std::int32_t type, std::int32_t sensor, const Pose& pose) {
  VrpnMessage message;
  message.sender = sender;
  message.type = type;
  message.payload.reserve(kPosQuatBytes);
  append_big(message.payload, sensor);
  append_big(message.payload, std::int32_t{0});
  const glm::dquat& q = pose.rotation;
  for (const double value : {pose.position_m.x, pose.position_m.y, pose.position_m.z, q.x, q.y, q.z, q.w})
    append_big(message.payload, value);
  return message;
}

void VrpnStream::feed(std::span<const std::byte> bytes) {
  if (broken_) return;
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(std::exchange(begin_, 0)));
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
}

std::optional<VrpnMessage> VrpnStream::next() {
  if (broken_) return std::nullopt;
  if (!greeted_) {
    if (pending_.size() < kVrpnCookieBytes) return std::nullopt;
    greeted_ = true;
    broken_ = !vrpn_cookie_fits(std::span(pending_).first(kVrpnCookieBytes));
    begin_ = kVrpnCookieBytes;
    if (broken_) return std::nullopt;
  }
  const auto left = std::span<const std::byte>(pending_).subspan(begin_);
  ByteReader reader(as_text(left));
  const auto length = reader.big<std::uint32_t>();
  if (!reader.ok()) return std::nullopt;
  if (length < kHeaderBytes || length > kVrpnMaxMessageBytes) {
    broken_ = true;
    return std::nullopt;
  }
  if (left.size() < padded(length)) return std::nullopt;
  VrpnMessage message;
  message.seconds = reader.big<std::uint32_t>();
  message.microseconds = reader.big<std::uint32_t>();
  message.sender = reader.big<std::int32_t>();
  message.type = reader.big<std::int32_t>();
  const auto payload = left.subspan(kHeaderBytes, length - kHeaderBytes);
  message.payload.assign(payload.begin(), payload.end());
  begin_ += padded(length);
  return message;
}

Result<void> VrpnProtocol::start(Transport& transport, TimestampNs) {
  *this = VrpnProtocol(std::move(choice_));
  return transport.write(vrpn_cookie());
}

Result<void> VrpnProtocol::keep_up(Transport&, TimestampNs) {
  if (stream_.broken())
    return fail(ErrorKind::kUnavailable, "vrpn: the server does not speak version 07, or the stream is damaged");
  if (goodbye_) return fail(ErrorKind::kUnavailable, "vrpn: the server has ended the connection");
  return {};
}

bool VrpnProtocol::accept(std::span<const std::byte> bytes, TimestampNs now) {
  stream_.feed(bytes);
  bool all_valid = true;
  while (const auto message = stream_.next()) all_valid = handle(*message, now) && all_valid;
  return all_valid && !stream_.broken();
}

std::string VrpnProtocol::note() const {
  if (found_) return {};
  const std::string wished =
      fmt::format("{}, sensor {}", choice_.tracker.empty() ? "any tracker" : choice_.tracker, choice_.sensor);
  std::string names;
  for (const auto& [tracker, sensors] : heard_) {
    std::string numbers;
    for (const std::int32_t sensor : sensors) numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", sensor);
    names += fmt::format("{}{} (sensor {})", names.empty() ? "" : ", ", tracker, numbers);
  }
  if (!names.empty()) return fmt::format("vrpn: no poses of {}; heard are: {}", wished, names);
  for (const auto& [number, name] : senders_) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  if (!names.empty())
    return fmt::format("vrpn: no poses of {}; the server names {}, and none sends poses", wished, names);
  return {};
}

bool VrpnProtocol::handle(const VrpnMessage& message, TimestampNs now) {
  ByteReader reader(as_text(message.payload));
  if (message.type == kVrpnSenderName || message.type == kVrpnTypeName) {
    const auto length = reader.big<std::uint32_t>();
    if (length > kMaxNameBytes) return false;
    std::string_view name = reader.take(length);
    if (!reader.ok()) return false;
    name = name.substr(0, name.find('\0'));
    auto& names = message.type == kVrpnSenderName ? senders_ : types_;
    if (names.size() >= kVrpnMaxNames && !names.contains(message.sender)) return false;
    names[message.sender] = std::string(name);
    return true;
  }
  if (message.type == kGoodbye) {
    goodbye_ = true;
    return true;
  }
  if (message.type < 0) return true;
  const auto type = types_.find(message.type);
  if (type == types_.end() || type->second != "vrpn_Tracker Pos_Quat") return true;
  if (message.payload.size() != kPosQuatBytes) return false;
  const auto sensor = reader.big<std::int32_t>();
  reader.big<std::int32_t>();
  std::array<double, 7> v;
  for (double& value : v) value = reader.big<double>();
  const auto sender = senders_.find(message.sender);
  if (const std::string name = sender == senders_.end() ? "?" : sender->second;
      heard_.size() < kMaxHeard || heard_.contains(name))
    if (auto& sensors = heard_[name]; sensors.size() < kMaxHeard) sensors.insert(sensor);
  if (!choice_.tracker.empty() && (sender == senders_.end() || sender->second != choice_.tracker)) return true;
  if (sensor != choice_.sensor) return true;
  if (choice_.tracker.empty()) {
    if (!first_sender_) first_sender_ = message.sender;
    if (*first_sender_ != message.sender) return true;
  }
  found_ = true;
  const TimestampNs said = 1'000'000'000 * TimestampNs{message.seconds} + 1000 * TimestampNs{message.microseconds};
  const TimestampNs time = said > 0 ? timeline_.host_time(said, now) : now;
  const auto passed = gate_.pass({time, {{v[0], v[1], v[2]}, glm::dquat(v[6], v[3], v[4], v[5])}, true, true});
  if (passed) newest_ = passed;
  return passed.has_value();
}

}  // namespace dubsar
