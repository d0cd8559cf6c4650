#pragma once
// A closed lump of clay whose places are known by a formula, for tests of comparisons.

#include <functional>

#include "core/compare/rigid_motion.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Of a direction (unit), how much farther out the lump is there, mm.
using LumpChange = std::function<double(const glm::dvec3&)>;

/// Half axes of 22, 26 and 8 mm with bumps that no turn maps onto themselves; `rings` of quads from pole to pole,
/// `phase` turns the pattern of triangles, so that two lumps of one shape share no vertex. mm are grid steps. Moved by
/// `motion` in the end.
TriMesh lump(int rings, double phase, const RigidMotion& motion, const LumpChange& change = {});

}  // namespace dubsar
