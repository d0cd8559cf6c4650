#pragma once
// The six sides of a tablet, and how it is turned to them: about the horizontal axis from the obverse over the bottom
// to the reverse and the top, so that the text of each stands upright; to the left and right edges about the upright
// axis.

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <string_view>

namespace dubsar::app {

enum class Side { kObverse, kBottom, kReverse, kTop, kLeft, kRight };
inline constexpr std::array<std::string_view, 6> kSideNames{"obverse", "bottom", "reverse", "top", "left", "right"};

/// From the obverse to a side; `home` turns the object to its obverse.
glm::dquat turn_to(Side side, const glm::dquat& home = {1.0, 0.0, 0.0, 0.0});

/// The side that faces the viewer most.
Side facing_side(const glm::dquat& rotation, const glm::dquat& home = {1.0, 0.0, 0.0, 0.0});

}  // namespace dubsar::app
