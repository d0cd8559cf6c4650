#pragma once
// A right or left hand made of round cones, in a pose: the truth of simulated pictures.

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/pose.h"

namespace dubsar {

struct HandPose {
  Pose palm{};  ///< in the device's frame; -Z to the fingers, +Y out of the back of the hand (OpenXR)
  std::array<double, 5> flexion{};  ///< thumb to little finger, 0: straight, 1: fist
  double spread = 1.0;              ///< 0: fingers together, 1: apart
  double scale = 1.0;               ///< 1: a hand 190 mm long and 86 mm wide
  bool left = false;
};

/// A round cone from a to b.
struct Cone {
  glm::dvec3 a_m{}, b_m{};
  double radius_a_m = 0, radius_b_m = 0;
};

struct PosedHand {
  std::vector<Cone> cones;                 ///< in the device's frame, forearm included
  std::array<glm::dvec3, 5> tips_m{};      ///< thumb to little finger
  std::array<glm::dvec3, 5> knuckles_m{};  ///< proximal joints
  glm::dvec3 wrist_m{}, palm_m{};          ///< palm: the middle of the middle metacarpal
};

/// Proportions after Greiner's hand anthropometry (NATICK/TR-92/011), rounded; joint ranges 85, 100, 60 degrees.
PosedHand pose_hand(const HandPose& pose);

}  // namespace dubsar
