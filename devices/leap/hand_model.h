#pragma once
// A right or left hand made of round cones, in a pose: the truth of simulated pictures.

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/numbers/pose.h"

namespace dubsar {

struct HandPose {
  Pose palm{};  ///< in the device's frame; -Z to the fingers, +Y out of the back of the hand (OpenXR)
  std::array<double, 5> flexion{};  ///< thumb to little finger, 0: straight, 1: fist
  double spread = 1.0;              ///< 0: fingers together, 1: apart
  double scale = 1.0;               ///< 1: a hand 190 mm long and 86 mm wide
  bool left = false;
  double wrist_turn_rad = 0.0;  ///< of the forearm against the hand, positive: the hand turned to its thumb's side
  double finger_length = 1.0;   ///< of the fingers and the thumb, beyond what `scale` does
  double palm_width = 1.0;      ///< across the palm, as well
  double thickness = 1.0;       ///< of everything, as well
};

inline constexpr std::size_t kHandConeCount = 26;

/// A round cone from a to b.
struct Cone {
  glm::dvec3 a_m{}, b_m{};
  double radius_a_m = 0, radius_b_m = 0;
};

struct PosedHand {
  std::vector<Cone> cones;                 ///< in the device's frame; the last four are wrist and forearm
  std::array<glm::dvec3, 5> tips_m{};      ///< thumb to little finger
  std::array<glm::dvec3, 5> knuckles_m{};  ///< proximal joints
  /// Thumb: metacarpal, proximal, distal, tip, tip. Others: metacarpal, proximal, intermediate, distal, tip (OpenXR).
  std::array<std::array<glm::dvec3, 5>, 5> joints_m{};
  std::array<std::array<double, 5>, 5> radii_m{};  ///< there
  glm::dvec3 wrist_m{}, palm_m{};                  ///< palm: the middle of the middle metacarpal
};

/// Proportions after Greiner's hand anthropometry (NATICK/TR-92/011), rounded; joint ranges 85, 100, 60 degrees.
PosedHand pose_hand(const HandPose& pose);

}  // namespace dubsar
