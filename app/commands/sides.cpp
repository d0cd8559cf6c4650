#include "app/commands/sides.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar::app {
namespace {

// Exact: what stands square is square, and comes back to the same numbers.
const double kHalf = std::sqrt(0.5);

glm::dquat turn_of_side(Side side) {
  switch (side) {
    case Side::kObverse:
      break;
    case Side::kBottom:
      return {kHalf, -kHalf, 0.0, 0.0};
    case Side::kReverse:
      return {0.0, 1.0, 0.0, 0.0};
    case Side::kTop:
      return {kHalf, kHalf, 0.0, 0.0};
    case Side::kLeft:
      return {kHalf, 0.0, kHalf, 0.0};
    case Side::kRight:
      return {kHalf, 0.0, -kHalf, 0.0};
  }
  return {1.0, 0.0, 0.0, 0.0};
}

}  // namespace

glm::dquat turn_to(Side side, const glm::dquat& home) { return glm::normalize(turn_of_side(side) * home); }

Side facing_side(const glm::dquat& rotation, const glm::dquat& home) {
  const glm::dvec3 viewer(0, 0, 1);
  const glm::dvec3 seen = glm::conjugate(rotation) * viewer;  // of the object, towards the viewer
  Side best = Side::kObverse;
  double most = -2.0;
  for (int i = 0; i < 6; ++i) {
    const auto side = static_cast<Side>(i);
    const double share = glm::dot(seen, glm::conjugate(turn_to(side, home)) * viewer);
    if (share > most + 1e-9) {
      most = share;
      best = side;
    }
  }
  return best;
}

}  // namespace dubsar::app
