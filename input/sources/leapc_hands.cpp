#include "input/sources/leapc_hands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <optional>

namespace dubsar {
namespace {

constexpr double kMPerMm = 0.001;

/// -z along `forward`, y as near to `up` as possible; none when the two do not span a plane.
std::optional<glm::dquat> looking_along(const glm::dvec3& forward, const glm::dvec3& up) {
  const double length = glm::length(forward);
  if (length < 1e-9) return std::nullopt;
  const glm::dvec3 back = -forward / length, across = glm::cross(up, back);
  const double width = glm::length(across);
  if (width < 1e-6) return std::nullopt;
  const glm::dvec3 x = across / width;
  return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(back, x), back)));
}

glm::dquat unit_or(const glm::dquat& rotation, const glm::dvec3& forward, const glm::dvec3& up) {
  const double length = glm::length(rotation);
  if (std::abs(length - 1.0) < 0.05) return rotation / length;
  return looking_along(forward, up).value_or(glm::dquat(1, 0, 0, 0));
}

struct JointSource {
  HandJoint joint;
  int digit, bone;
  bool end;  ///< the bone's end, else its base
};

// Every joint is the base of the bone that leaves it, tips are ends.
constexpr std::array<JointSource, 24> kJoints{{
    {HandJoint::kThumbMetacarpal, 0, 1, false},
    {HandJoint::kThumbProximal, 0, 2, false},
    {HandJoint::kThumbDistal, 0, 3, false},
    {HandJoint::kThumbTip, 0, 3, true},
    {HandJoint::kIndexMetacarpal, 1, 0, false},
    {HandJoint::kIndexProximal, 1, 1, false},
    {HandJoint::kIndexIntermediate, 1, 2, false},
    {HandJoint::kIndexDistal, 1, 3, false},
    {HandJoint::kIndexTip, 1, 3, true},
    {HandJoint::kMiddleMetacarpal, 2, 0, false},
    {HandJoint::kMiddleProximal, 2, 1, false},
    {HandJoint::kMiddleIntermediate, 2, 2, false},
    {HandJoint::kMiddleDistal, 2, 3, false},
    {HandJoint::kMiddleTip, 2, 3, true},
    {HandJoint::kRingMetacarpal, 3, 0, false},
    {HandJoint::kRingProximal, 3, 1, false},
    {HandJoint::kRingIntermediate, 3, 2, false},
    {HandJoint::kRingDistal, 3, 3, false},
    {HandJoint::kRingTip, 3, 3, true},
    {HandJoint::kLittleMetacarpal, 4, 0, false},
    {HandJoint::kLittleProximal, 4, 1, false},
    {HandJoint::kLittleIntermediate, 4, 2, false},
    {HandJoint::kLittleDistal, 4, 3, false},
    {HandJoint::kLittleTip, 4, 3, true},
}};

}  // namespace

HandFrame hand_from_leapc(const leapc::Hand& hand, TimestampNs time) {
  HandFrame frame;
  frame.time = time;
  frame.id = hand.id;
  frame.chirality = hand.side == leapc::Side::kLeft    ? Chirality::kLeft
                    : hand.side == leapc::Side::kRight ? Chirality::kRight
                                                       : Chirality::kUnknown;
  frame.valid = frame.tracked = true;
  frame.confidence = std::clamp(hand.confidence, 0.0, 1.0);
  frame.palm = {kMPerMm * hand.palm_mm, unit_or(hand.palm_rotation, hand.direction, -hand.normal)};
  frame.velocity_mps = kMPerMm * hand.velocity_mmps;
  frame.grab_strength = std::clamp(hand.grab_strength, 0.0, 1.0);

  const glm::dvec3 up = frame.palm.rotation * glm::dvec3(0, 1, 0);
  const auto place = [&](HandJoint which, const glm::dvec3& at_mm, const leapc::Bone& bone) {
    frame.joint(which) = {{kMPerMm * at_mm, unit_or(bone.rotation, bone.end_mm - bone.base_mm, up)},
                          std::max(0.0, 0.5 * kMPerMm * bone.width_mm),
                          true,
                          true};
  };
  for (const JointSource& from : kJoints) {
    const leapc::Bone& bone = hand.digits[static_cast<std::size_t>(from.digit)][static_cast<std::size_t>(from.bone)];
    place(from.joint, from.end ? bone.end_mm : bone.base_mm, bone);
  }
  place(HandJoint::kWrist, hand.arm.end_mm, hand.arm);
  frame.joint(HandJoint::kPalm) = {frame.palm, std::max(0.0, 0.5 * kMPerMm * hand.palm_width_mm), true, true};
  frame.pinch_distance_m = glm::distance(frame.joint(HandJoint::kThumbTip).pose.position_m,
                                         frame.joint(HandJoint::kIndexTip).pose.position_m);
  return frame;
}

}  // namespace dubsar
