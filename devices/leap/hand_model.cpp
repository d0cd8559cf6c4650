#include "devices/leap/hand_model.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/numbers/angle.h"

namespace dubsar {
namespace {

constexpr double kMm = 1e-3;

// In millimetres, right hand in the palm frame: -Z to the fingers, +Y to the back, the thumb on -X.
struct Finger {
  glm::dvec3 carpal, knuckle;
  std::array<double, 3> bones;  ///< proximal, intermediate, distal up to the centre of the tip
  std::array<double, 4> radii;  ///< at the joints and the tip
  double fan_degrees;           ///< towards +X at full spread
  double metacarpal_radius;
};
constexpr std::array<Finger, 4> kFingers{{
    {{-14, 0, 36}, {-27, 0, -33}, {43, 25, 17}, {10.0, 9.0, 8.0, 7.0}, -13.0, 13.5},
    {{-4, 1, 35}, {-4, 1, -35}, {47, 29, 18}, {10.0, 9.0, 8.0, 7.2}, -2.0, 14.0},
    {{6, 0, 36}, {17, 0, -31}, {43, 28, 18}, {9.5, 8.5, 7.6, 6.8}, 8.0, 13.5},
    {{14, -2, 37}, {35, -3, -23}, {33, 20, 16}, {8.5, 7.5, 6.8, 6.2}, 19.0, 12.0},
}};
constexpr std::array<double, 3> kFlexionDegrees{85.0, 100.0, 60.0};

glm::dvec3 mirrored(glm::dvec3 v, bool left) { return left ? glm::dvec3(-v.x, v.y, v.z) : v; }

}  // namespace

PosedHand pose_hand(const HandPose& pose) {
  PosedHand hand;
  hand.cones.reserve(kHandConeCount);
  const double unit = kMm * pose.scale, thickness = unit * pose.thickness;
  const auto wide = [&](const glm::dvec3& local_mm) {
    return glm::dvec3(local_mm.x * pose.palm_width, local_mm.y, local_mm.z);
  };
  const auto place = [&](const glm::dvec3& local_mm) {
    return transform(pose.palm, mirrored(local_mm, pose.left) * unit);
  };
  const auto cone = [&](const glm::dvec3& a, double radius_a, const glm::dvec3& b, double radius_b) {
    hand.cones.push_back({place(a), place(b), radius_a * thickness, radius_b * thickness});
  };

  for (std::size_t f = 0; f < 4; ++f) {
    const Finger& finger = kFingers[f];
    cone(wide(finger.carpal), 13.5, wide(finger.knuckle), finger.metacarpal_radius * 0.85);
    hand.joints_m[f + 1][0] = place(wide(finger.carpal));
    hand.radii_m[f + 1][0] = 13.5 * thickness;
    glm::dquat turn = glm::angleAxis(-finger.fan_degrees * pose.spread * (1.0 - 0.8 * pose.flexion[f + 1]) * kRadPerDeg,
                                     glm::dvec3(0, 1, 0));
    glm::dvec3 joint = wide(finger.knuckle);
    for (std::size_t bone = 0; bone < 3; ++bone) {
      hand.joints_m[f + 1][bone + 1] = place(joint);
      hand.radii_m[f + 1][bone + 1] = finger.radii[bone] * thickness;
      // +X turns -Z towards... the palm side is -Y: a negative turn about X bends the finger to it.
      turn = turn * glm::angleAxis(-kFlexionDegrees[bone] * pose.flexion[f + 1] * kRadPerDeg, glm::dvec3(1, 0, 0));
      const glm::dvec3 next = joint + turn * glm::dvec3(0, 0, -finger.bones[bone] * pose.finger_length);
      cone(joint, finger.radii[bone], next, finger.radii[bone + 1]);
      joint = next;
    }
    hand.knuckles_m[f + 1] = hand.joints_m[f + 1][1];
    hand.tips_m[f + 1] = hand.joints_m[f + 1][4] = place(joint);
    hand.radii_m[f + 1][4] = finger.radii[3] * thickness;
  }
  // The skin between the metacarpals, thumb side and outer side of the palm.
  cone(wide({-12, -3, 10}), 16, wide({-18, -2, -18}), 15);
  cone(wide({14, -4, 14}), 16, wide({22, -3, -12}), 14);
  cone(wide({2, -2, 20}), 16, wide({2, 0, -22}), 15);

  const double bent = pose.flexion[0];
  const glm::dvec3 thumb_root = wide({-17, -6, 34});
  const glm::dquat out =
      glm::angleAxis((52.0 - 22.0 * bent - 22.0 * (1.0 - pose.spread)) * kRadPerDeg, glm::dvec3(0, 1, 0)) *
      glm::angleAxis((-14.0 - 18.0 * bent) * kRadPerDeg, glm::dvec3(1, 0, 0));
  glm::dvec3 joint = thumb_root;
  glm::dquat turn = out;
  constexpr std::array<double, 3> kThumbBones{44, 32, 22}, kThumbBend{0.0, -50.0, -60.0};
  constexpr std::array<double, 4> kThumbRadii{15, 11.5, 10, 8.5};
  for (std::size_t bone = 0; bone < 3; ++bone) {
    turn = turn * glm::angleAxis(kThumbBend[bone] * bent * kRadPerDeg, glm::dvec3(0, 1, 0));
    const glm::dvec3 next = joint + turn * glm::dvec3(0, 0, -kThumbBones[bone] * pose.finger_length);
    cone(joint, kThumbRadii[bone], next, kThumbRadii[bone + 1]);
    hand.joints_m[0][bone] = place(joint);
    hand.radii_m[0][bone] = kThumbRadii[bone] * thickness;
    if (bone == 0) hand.knuckles_m[0] = place(next);
    joint = next;
  }
  hand.tips_m[0] = hand.joints_m[0][3] = hand.joints_m[0][4] = place(joint);
  hand.radii_m[0][3] = hand.radii_m[0][4] = kThumbRadii[3] * thickness;

  // Wrist and forearm: two cones side by side, flatter than wide.
  const glm::dvec3 wrist(0, 0, 52);
  const glm::dquat arm = glm::angleAxis(pose.wrist_turn_rad, glm::dvec3(0, 1, 0));
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 near = wrist + arm * (wide({13 * side, 0, 70}) - wrist),
                     far = wrist + arm * (wide({18 * side, 0, 280}) - wrist);
    cone(wide({13 * side, 0, 38}), 16, near, 17);
    cone(near, 17, far, 27);
  }
  hand.wrist_m = place(wrist);
  hand.palm_m = place({0, 0, 0});
  return hand;
}

}  // namespace dubsar
