#pragma once
// What the outline of a hand says before any model is fitted: palm, direction of the arm, reach of the
// fingers.

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "input/tracking/hands/hand_picture.h"

namespace dubsar {

struct Silhouette {
  glm::dvec2 palm_px{};          ///< centre of the largest circle in the palm
  double radius_px = 0.0;        ///< of that circle
  glm::dvec2 forward{0.0, 1.0};  ///< unit, picture axes: away from the arm
  double reach = 0.0;            ///< of the fingers from the palm, in radii
  bool arm_seen = false;
  std::vector<double> finger_rad;  ///< directions of fingers that stick out, rising, from forward, positive from x to y
};

/// For hands held palm down whose arm comes from the top of the picture. `distance` is scratch. Nothing: too
/// small.
std::optional<Silhouette> outline(std::span<const std::uint8_t> labels, int width, int height, const Region& region,
                                  std::vector<float>& distance);

}  // namespace dubsar
