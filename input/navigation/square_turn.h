#pragma once
// Views that stand square.

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <initializer_list>

namespace dubsar {

/// The axis-parallel turn nearest to `q`: one of the 24 turns of a cube.
inline glm::dquat nearest_square_turn(const glm::dquat& q) {
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

}  // namespace dubsar
