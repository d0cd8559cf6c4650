#include "app/commands/sides.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

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

glm::dquat nearest_square_turn(const glm::dquat& q) {
  const glm::dmat3 m = glm::mat3_cast(q);
  double best = -4.0;
  glm::dmat3 out(1.0);
  for (int x = 0; x < 3; ++x)
    for (const double sx : {-1.0, 1.0})
      for (int y = 0; y < 3; ++y)
        for (const double sy : {-1.0, 1.0}) {
          if (y == x) continue;
          glm::dmat3 candidate(0.0);
          candidate[0][x] = sx;
          candidate[1][y] = sy;
          candidate[2] = glm::cross(candidate[0], candidate[1]);
          double trace = 0.0;
          for (int c = 0; c < 3; ++c) trace += glm::dot(m[c], candidate[c]);
          if (trace > best) {
            best = trace;
            out = candidate;
          }
        }
  return glm::normalize(glm::quat_cast(out));
}

}  // namespace dubsar::app
