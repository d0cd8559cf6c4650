#pragma once
// What Ultraleap's LeapC library writes into memory: structs packed to one byte, read here by offset, so that
// no vendor header is needed. Layout of LeapC 5 and 6 on 64-bit Linux, from the vendor's public documentation
// of the API.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dubsar::leapc {

// --- numbers of the API ---

inline constexpr std::uint32_t kSuccess = 0;
inline constexpr std::uint32_t kTimeout = 0xe2010004;
inline constexpr std::uint32_t kNotConnected = 0xe2010005;
inline constexpr std::uint32_t kConcurrentPoll = 0xe201000f;
inline constexpr std::uint32_t kNotAvailable = 0xe7010002;

/// The words for a result code, the number where it has none.
std::string result_text(std::uint32_t code);

enum class Event : std::uint32_t {
  kConnection = 1,
  kConnectionLost = 2,
  kDevice = 3,
  kDeviceFailure = 4,
  kPolicy = 5,
  kTracking = 0x100,
  kDeviceLost = 0x104,
  kDeviceStatus = 0x107,
  kDroppedFrame = 0x108,
  kImage = 0x109,
  kTrackingMode = 0x10b,
};

/// How the device is mounted.
enum class Mode : std::uint32_t { kDesktop = 0, kHeadMounted = 1, kScreenTop = 2 };
inline constexpr std::uint64_t kPolicyBackgroundFrames = 0x1;
inline constexpr std::uint64_t kPolicyImages = 0x2;
inline constexpr std::uint64_t kPolicyMapPoints = 0x80;

// --- where things lie ---

inline constexpr std::size_t kVectorBytes = 12, kQuaternionBytes = 16;
inline constexpr std::size_t kBoneBytes = 2 * kVectorBytes + 4 + kQuaternionBytes;
inline constexpr std::size_t kDigitBytes = 4 + 4 * kBoneBytes + 4;
inline constexpr std::size_t kPalmBytes = 4 * kVectorBytes + 4 + kVectorBytes + kQuaternionBytes;
inline constexpr std::size_t kPalmAt = 40, kDigitsAt = kPalmAt + kPalmBytes, kArmAt = kDigitsAt + 5 * kDigitBytes;
inline constexpr std::size_t kHandBytes = kArmAt + kBoneBytes;
static_assert(kBoneBytes == 44 && kDigitBytes == 184 && kPalmBytes == 80);
static_assert(kDigitsAt == 120 && kArmAt == 1040 && kHandBytes == 1084);
inline constexpr std::size_t kTrackingBytes = 48, kMessageBytes = 20, kDeviceBytes = 20, kModeBytes = 8;

/// More hands in one frame are taken for damage.
inline constexpr std::uint32_t kMostHands = 16;

// --- what they mean; millimetres, x along the device, y out of it, z to the user ---

enum class Side { kUnknown, kLeft, kRight };

struct Bone {
  glm::dvec3 base_mm{}, end_mm{};  ///< base: nearer to the heart
  double width_mm = 0;
  glm::dquat rotation{1, 0, 0, 0};  ///< -z along the bone to its end, y to the back of the hand
};

struct Hand {
  std::uint32_t id = 0;
  Side side = Side::kUnknown;
  double confidence = 0;
  std::uint64_t visible_us = 0;
  double pinch_strength = 0, grab_strength = 0;
  glm::dvec3 palm_mm{}, velocity_mmps{}, normal{}, direction{};
  double palm_width_mm = 0;
  glm::dquat palm_rotation{1, 0, 0, 0};
  std::array<std::array<Bone, 4>, 5> digits{};  ///< thumb to little; metacarpal (of no length in the thumb) to distal
  Bone arm{};
};

/// kBadData: not kHandBytes, a number that is not finite, or a place more than 10 m away.
Result<Hand> decode_hand(std::span<const std::byte> bytes);
std::array<std::byte, kHandBytes> encode(const Hand& hand) noexcept;

struct Message {
  std::uint32_t bytes = 0;  ///< of the event; its length as the library says it
  Event type{};
  std::uintptr_t event = 0;
  std::uint32_t device = 0;
};
Message decode_message(std::span<const std::byte, kMessageBytes> bytes) noexcept;

struct Tracking {
  std::int64_t frame = 0;
  std::int64_t time_us = 0;  ///< of the library's clock
  std::uint32_t hands = 0;
  std::uintptr_t hands_at = 0;
  double frames_per_s = 0;
};
/// kBadData: more than kMostHands, hands without an address, or a time beyond 200 years.
Result<Tracking> decode_tracking(std::span<const std::byte, kTrackingBytes> bytes);

struct Device {
  std::uint32_t id = 0;
  std::uint32_t status = 0;
};
/// Of the events kDevice and kDeviceLost.
Device decode_device(std::span<const std::byte, kDeviceBytes> bytes) noexcept;
/// Of the event kDeviceStatus.
Device decode_device_status(std::span<const std::byte, kDeviceBytes> bytes) noexcept;

/// What a device's status says when it cannot be used, and what to do; empty when it can.
std::string device_trouble(std::uint32_t status);

}  // namespace dubsar::leapc
