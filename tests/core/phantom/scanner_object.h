#pragma once
// Simple objects whose line integrals are known, for tests of the simulated scanner.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/phantom/scanner/projector.h"

namespace dubsar::phantom::testing {

/// Voxels of a ball with partial volume; `centre` from the middle of the grid.
inline Columns ball(const Dims& d, const glm::dvec3& centre, double radius) {
  Columns out(d.x, d.y, d.z);
  out.clear();
  const glm::dvec3 middle = 0.5 * glm::dvec3(d.x - 1, d.y - 1, d.z - 1) + centre;
  for (std::int64_t x = 0; x < d.x; ++x)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t z = 0; z < d.z; ++z)
        out.at(x, y)[z] =
            static_cast<float>(std::clamp(0.5 + radius - glm::length(glm::dvec3(x, y, z) - middle), 0.0, 1.0));
  return out;
}

/// Length of the ray of pixel (u, v) in that ball, voxels.
inline double chord(const ScanGeometry& g, double angle, double u, double v, const glm::dvec3& centre, double radius) {
  const glm::dvec3 s(std::cos(angle), std::sin(angle), 0.0), t(-std::sin(angle), std::cos(angle), 0.0);
  const glm::dvec3 through = u * t + glm::dvec3(0, 0, v);
  const glm::dvec3 along = g.cone() ? glm::normalize(through - g.source * s) : s;
  const glm::dvec3 to = centre - through;
  const double off2 = glm::dot(to, to) - glm::dot(to, along) * glm::dot(to, along);
  return off2 < radius * radius ? 2.0 * std::sqrt(radius * radius - off2) : 0.0;
}

inline ScanGeometry geometry(const Dims& d, double cone, bool full, int views, double axis = 0.0,
                             double voxel_mm = 0.25) {
  TurnOptions turn;
  turn.cone_deg = cone;
  turn.full = full;
  turn.views = views;
  turn.axis_px = axis;
  return make_geometry(d, voxel_mm, turn).value();
}

inline Columns project_quietly(const Columns& object, const ScanGeometry& g) {
  SilentProgress progress;
  return project(object, g, progress).value();
}
inline Columns reconstruct_quietly(const Columns& views, const ScanGeometry& g, Window window = Window::kNone) {
  SilentProgress progress;
  return reconstruct(views, g, window, progress).value();
}

}  // namespace dubsar::phantom::testing
