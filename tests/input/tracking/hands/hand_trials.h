#pragma once
// Random simulated hands and their pictures.

#include <random>
#include <span>

#include "core/base/system/clock.h"
#include "devices/frame_source.h"
#include "devices/leap/hand_renderer.h"

namespace dubsar {

inline constexpr double kDegree = 3.14159265358979 / 180.0;

struct HandKind {
  bool fist = false;
  double proportions = 0.0;     ///< up to which part finger length, palm width and thickness differ, each on its own
  double wrist_turn_rad = 0.0;  ///< up to
  bool lit_from_eyes = false;   ///< a light at each eye instead of three along the device
  bool soft = false;            ///< out of focus: 1 2 1 over the pictures in both directions
  bool sleeve = false;          ///< nothing of the arm from 18 mm behind the wrist on
};

/// Anywhere in the zone, palm down, 0.9 to 1.1 of the usual size, turned by up to 25 and tilted by up to 8
/// degrees each way.
inline HandPose random_hand(std::mt19937& random, double height_m, const HandKind& kind) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto about_one = [&] { return 1.0 + kind.proportions * uniform(-1.0, 1.0); };
  HandPose pose;
  pose.palm.position_m = {uniform(-0.25, 0.25) * height_m, height_m, uniform(-0.25, 0.25) * height_m};
  const double turn = uniform(-25, 25), pitch = uniform(-8, 8), roll = uniform(-8, 8);
  pose.palm.rotation = glm::angleAxis(turn * kDegree, glm::dvec3(0, 1, 0)) *
                       glm::angleAxis(pitch * kDegree, glm::dvec3(1, 0, 0)) *
                       glm::angleAxis(roll * kDegree, glm::dvec3(0, 0, 1));
  for (double& flexion : pose.flexion) flexion = kind.fist ? uniform(0.9, 1.0) : uniform(0.0, 0.12);
  pose.spread = uniform(0.6, 1.0);
  pose.scale = uniform(0.9, 1.1);
  pose.left = random() % 2 == 0;
  pose.finger_length = about_one();
  pose.palm_width = about_one();
  pose.thickness = about_one();
  pose.wrist_turn_rad = kind.wrist_turn_rad * uniform(-1.0, 1.0);
  return pose;
}

inline Frame render_frame(const HandRenderer& renderer, std::span<const PosedHand> hands, std::uint64_t seed) {
  Frame frame;
  frame.width = renderer.options().width;
  frame.height = renderer.options().height;
  frame.views = 2;
  frame.pixels.resize(2 * frame.view_bytes());
  const std::span pixels(frame.pixels);
  renderer.render(hands, seed, pixels.first(frame.view_bytes()), pixels.last(frame.view_bytes()));
  return frame;
}

}  // namespace dubsar
