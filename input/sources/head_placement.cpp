#include "input/sources/head_placement.h"

#include <cmath>

namespace dubsar {
namespace {

constexpr glm::dvec3 kEyesFromNeck_m{0.0, 0.075, -0.0805};
constexpr double kNearest_m = 0.1, kFarthest_m = 3.0, kFarthestBeside_m = 2.5;

}  // namespace

std::optional<HeadFrame> head_frame(const HeadSample& sample, const HeadPlacement& placement) {
  const Pose& place = placement.screen_from_tracker;
  const glm::dquat turn = place.rotation * (sample.has_orientation ? sample.pose.rotation : glm::dquat(1, 0, 0, 0));
  glm::dvec3 middle{0.0};
  if (sample.has_position) {
    middle = transform(place, sample.pose.position_m) + turn * placement.eyes_m;
  } else {
    middle = place.position_m - kEyesFromNeck_m + turn * (kEyesFromNeck_m + placement.eyes_m);
  }
  HeadFrame head;
  head.time = sample.time;
  head.tracked = true;
  head.confidence = sample.has_position ? 1.0 : 0.5;
  const glm::dvec3 half = turn * glm::dvec3(0.5 * placement.ipd_m, 0.0, 0.0);
  head.left_eye_m = middle - half;
  head.right_eye_m = middle + half;
  for (const glm::dvec3& eye : {*head.left_eye_m, *head.right_eye_m}) {
    if (!(eye.z >= kNearest_m && eye.z <= kFarthest_m)) return std::nullopt;
    if (!(std::abs(eye.x) <= kFarthestBeside_m && std::abs(eye.y) <= kFarthestBeside_m)) return std::nullopt;
  }
  return head;
}

}  // namespace dubsar
