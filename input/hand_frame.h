#pragma once
// A tracked hand at one moment: what every hand tracker delivers and what gestures read.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/numbers/pose.h"
#include "core/base/system/clock.h"

namespace dubsar {

/// The 26 joints in the order of OpenXR (XR_EXT_hand_tracking).
enum class HandJoint : int {
  kPalm,
  kWrist,
  kThumbMetacarpal,
  kThumbProximal,
  kThumbDistal,
  kThumbTip,
  kIndexMetacarpal,
  kIndexProximal,
  kIndexIntermediate,
  kIndexDistal,
  kIndexTip,
  kMiddleMetacarpal,
  kMiddleProximal,
  kMiddleIntermediate,
  kMiddleDistal,
  kMiddleTip,
  kRingMetacarpal,
  kRingProximal,
  kRingIntermediate,
  kRingDistal,
  kRingTip,
  kLittleMetacarpal,
  kLittleProximal,
  kLittleIntermediate,
  kLittleDistal,
  kLittleTip,
};
inline constexpr std::size_t kHandJointCount = 26;

enum class Chirality : std::uint8_t { kUnknown, kLeft, kRight };

struct HandJointPose {
  Pose pose{};
  double radius_m = 0.0;  ///< half the finger's thickness; 0: unknown
  bool valid = false;     ///< the pose can be used: measured, or inferred from other joints
  bool tracked = false;   ///< measured in this very frame
  bool operator==(const HandJointPose&) const = default;
};

/// Lengths in metres, right-handed, +X right, +Y up, +Z to the user. A tracker's own frame has its origin in the
/// device; what an InputSource hands out is moved to the screen frame (panel centre). OpenXR axes: a joint's -Z points
/// to the finger tip, +Y out of the back of the hand.
struct HandFrame {
  TimestampNs time = 0;  ///< when the device measured it, monotonic clock
  std::uint32_t id = 0;  ///< stays the same while this hand is followed without a break
  Chirality chirality = Chirality::kUnknown;
  bool valid = false;             ///< palm, grab and pinch can be used
  bool tracked = false;           ///< measured now; false: held or predicted
  double confidence = 0.0;        ///< 0..1
  Pose palm{};                    ///< centre of the palm; the same as joint kPalm
  glm::dvec3 velocity_mps{0.0};   ///< of the palm
  double grab_strength = 0.0;     ///< 0: open hand, 1: fist
  double pinch_distance_m = 0.1;  ///< thumb tip to index tip, surface to surface or centre to centre
  std::array<HandJointPose, kHandJointCount> joints{};
  bool operator==(const HandFrame&) const = default;

  const HandJointPose& joint(HandJoint which) const noexcept { return joints[static_cast<std::size_t>(which)]; }
  HandJointPose& joint(HandJoint which) noexcept { return joints[static_cast<std::size_t>(which)]; }
};

/// The point for a cursor: mean of the index and middle knuckles, which a pinch does not move; the palm where they are
/// not valid.
inline glm::dvec3 cursor_point_m(const HandFrame& hand) noexcept {
  const auto& index = hand.joint(HandJoint::kIndexProximal);
  const auto& middle = hand.joint(HandJoint::kMiddleProximal);
  return index.valid && middle.valid ? 0.5 * (index.pose.position_m + middle.pose.position_m) : hand.palm.position_m;
}

/// The hand in another frame: everything with a place or a direction is moved, lengths stay.
inline HandFrame moved(const Pose& target_from_hand, HandFrame hand) noexcept {
  hand.palm = compose(target_from_hand, hand.palm);
  hand.velocity_mps = target_from_hand.rotation * hand.velocity_mps;
  for (HandJointPose& joint : hand.joints)
    if (joint.valid) joint.pose = compose(target_from_hand, joint.pose);
  return hand;
}

/// All hands of one moment, at most kMaxHands.
inline constexpr std::size_t kMaxHands = 8;
using Hands = std::vector<HandFrame>;

}  // namespace dubsar
