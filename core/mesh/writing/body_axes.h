#pragma once
// The axes of a body that has six sides more or less: a tablet, an envelope.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct BodyAxes {
  glm::dmat3 axes{1.0};    ///< columns, right-handed, unit: across the broad sides, then along their edges
  glm::dvec3 extent{0.0};  ///< mm along each
};

/// From the areas of the faces that look along them: eigenvectors of the sum of n n^T by area, the broad sides first,
/// the others turned to where the edges look (of a square tablet the areas do not say it, the fourth harmonic of the
/// directions does). A sum over the surface: the same for every mesh of it and for every attitude. kBadData: no area.
Result<BodyAxes> body_axes(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles);

}  // namespace dubsar
