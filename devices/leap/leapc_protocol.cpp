#include "devices/leap/leapc_protocol.h"

#include <cmath>
#include <cstring>
#include <type_traits>

namespace dubsar::leapc {
namespace {

constexpr double kFarthestMm = 10'000.0;
constexpr std::int64_t kLatestUs = std::int64_t{200} * 366 * 24 * 3600 * 1'000'000;

template <class T>
T get(std::span<const std::byte> bytes, std::size_t at) noexcept {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// One description of the layout for both directions: visit(offset, field) for every field of a hand that we
// know.
template <class Hand, class Visit>
void for_each_field(Hand& hand, const Visit& visit) {
  const auto bone = [&](std::size_t at, auto& b) {
    visit(at, b.base_mm);
    visit(at + 12, b.end_mm);
    visit(at + 24, b.width_mm);
    visit(at + 28, b.rotation);
  };
  visit(0, hand.id);
  visit(12, hand.confidence);
  visit(16, hand.visible_us);
  visit(32, hand.pinch_strength);
  visit(36, hand.grab_strength);
  visit(kPalmAt, hand.palm_mm);
  visit(kPalmAt + 24, hand.velocity_mmps);
  visit(kPalmAt + 36, hand.normal);
  visit(kPalmAt + 48, hand.palm_width_mm);
  visit(kPalmAt + 52, hand.direction);
  visit(kPalmAt + 64, hand.palm_rotation);
  for (std::size_t digit = 0; digit < 5; ++digit)
    for (std::size_t i = 0; i < 4; ++i)
      bone(kDigitsAt + digit * kDigitBytes + 4 + i * kBoneBytes, hand.digits[digit][i]);
  bone(kArmAt, hand.arm);
}

bool place_is_near(const glm::dvec3& mm) {
  return std::abs(mm.x) <= kFarthestMm && std::abs(mm.y) <= kFarthestMm && std::abs(mm.z) <= kFarthestMm;
}

}  // namespace

std::string result_text(std::uint32_t code) {
  switch (code) {
    case kSuccess:
      return "success";
    case 0xe2010001:
      return "invalid argument";
    case 0xe2010002:
      return "insufficient resources";
    case kTimeout:
      return "timeout";
    case kNotConnected:
      return "not connected to the service";
    case 0xe2010006:
      return "the handshake with the service is not complete";
    case 0xe2010008:
      return "protocol error";
    case 0xe201000a:
      return "the service closed the connection";
    case kConcurrentPoll:
      return "the connection is polled by two threads at once";
    case kNotAvailable:
      return "the service cannot be reached";
    case 0xe7010006:
      return "this version of the service does not support it";
    default:
      return fmt::format("error {:#010x}", code);
  }
}

Result<Hand> decode_hand(std::span<const std::byte> bytes) {
  if (bytes.size() != kHandBytes)
    return fail(ErrorKind::kBadData, "leapc: a hand of {} bytes, expected {}", bytes.size(), kHandBytes);
  Hand hand;
  bool finite = true, near = true;
  const auto number = [&](std::size_t at) {
    const float value = get<float>(bytes, at);
    finite = finite && std::isfinite(value);
    return double{value};
  };
  for_each_field(hand, [&](std::size_t at, auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    if constexpr (std::is_integral_v<Field>) {
      field = get<Field>(bytes, at);
    } else if constexpr (std::is_same_v<Field, double>) {
      field = number(at);
    } else if constexpr (std::is_same_v<Field, glm::dvec3>) {
      field = {number(at), number(at + 4), number(at + 8)};
    } else {
      const double x = number(at), y = number(at + 4), z = number(at + 8);
      field = glm::dquat(number(at + 12), x, y, z);
    }
  });
  if (!finite) return fail(ErrorKind::kBadData, "leapc: hand {} has a number that is not finite", hand.id);
  near = place_is_near(hand.palm_mm) && place_is_near(hand.arm.base_mm) && place_is_near(hand.arm.end_mm);
  for (const auto& digit : hand.digits)
    for (const Bone& bone : digit) near = near && place_is_near(bone.base_mm) && place_is_near(bone.end_mm);
  if (!near) return fail(ErrorKind::kBadData, "leapc: hand {} is more than 10 m away", hand.id);
  const auto type = get<std::uint32_t>(bytes, 8);
  hand.side = type == 0 ? Side::kLeft : type == 1 ? Side::kRight : Side::kUnknown;
  return hand;
}

std::array<std::byte, kHandBytes> encode(const Hand& hand) noexcept {
  std::array<std::byte, kHandBytes> bytes{};
  const auto number = [&](std::size_t at, double value) {
    const auto single = static_cast<float>(value);
    std::memcpy(bytes.data() + at, &single, sizeof single);
  };
  for_each_field(hand, [&](std::size_t at, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    if constexpr (std::is_integral_v<Field>) {
      std::memcpy(bytes.data() + at, &field, sizeof field);
    } else if constexpr (std::is_same_v<Field, double>) {
      number(at, field);
    } else {
      number(at, field.x);
      number(at + 4, field.y);
      number(at + 8, field.z);
      if constexpr (std::is_same_v<Field, glm::dquat>) number(at + 12, field.w);
    }
  });
  const std::uint32_t type = hand.side == Side::kLeft ? 0U : hand.side == Side::kRight ? 1U : 2U;
  std::memcpy(bytes.data() + 8, &type, sizeof type);
  return bytes;
}

Message decode_message(std::span<const std::byte, kMessageBytes> bytes) noexcept {
  Message message;
  message.bytes = get<std::uint32_t>(bytes, 0);
  message.type = static_cast<Event>(get<std::uint32_t>(bytes, 4));
  message.event = get<std::uintptr_t>(bytes, 8);
  message.device = get<std::uint32_t>(bytes, 16);
  return message;
}

Result<Tracking> decode_tracking(std::span<const std::byte, kTrackingBytes> bytes) {
  Tracking tracking;
  tracking.frame = get<std::int64_t>(bytes, 8);
  tracking.time_us = get<std::int64_t>(bytes, 16);
  tracking.hands = get<std::uint32_t>(bytes, 32);
  tracking.hands_at = get<std::uintptr_t>(bytes, 36);
  tracking.frames_per_s = double{get<float>(bytes, 44)};
  if (tracking.hands > kMostHands)
    return fail(ErrorKind::kBadData, "leapc: a frame with {} hands, expected at most {}", tracking.hands, kMostHands);
  if (tracking.hands > 0 && tracking.hands_at == 0)
    return fail(ErrorKind::kBadData, "leapc: a frame with {} hands and no address of them", tracking.hands);
  if (tracking.time_us < -kLatestUs || tracking.time_us > kLatestUs)
    return fail(ErrorKind::kBadData, "leapc: a frame of the time {} us", tracking.time_us);
  return tracking;
}

Device decode_device(std::span<const std::byte, kDeviceBytes> bytes) noexcept {
  return {get<std::uint32_t>(bytes, 12), get<std::uint32_t>(bytes, 16)};
}

Device decode_device_status(std::span<const std::byte, kDeviceBytes> bytes) noexcept {
  return {get<std::uint32_t>(bytes, 8), get<std::uint32_t>(bytes, 16)};
}

std::string device_trouble(std::uint32_t status) {
  switch (status) {
    case 0xe8010000:
      return "the device has failed: plug it in again";
    case 0xe8010001:
      return "the device's calibration is damaged: it needs its maker's repair tool";
    case 0xe8010002:
      return "the device's firmware is damaged or too old: update it with Ultraleap's control panel";
    case 0xe8010003:
      return "the USB connection is faulty: try another cable and a port of the machine itself";
    case 0xe8010004:
      return "the device's USB controls do not answer: plug it in again";
    default:
      break;
  }
  if ((status & 0xffff0000U) == 0xe8010000U) return fmt::format("the device has failed (status {:#010x})", status);
  if ((status & 0x2U) != 0) return "tracking is paused: resume it in Ultraleap's control panel";
  return {};
}

}  // namespace dubsar::leapc
