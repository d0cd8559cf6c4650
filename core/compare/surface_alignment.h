#pragma once
// One surface laid on another: a tablet scanned twice.

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/compare/nearest_surface.h"
#include "core/compare/rigid_motion.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct SurfaceAlignment {
  RigidMotion a_from_b;  ///< mm
  double rms_mm = 0.0;   ///< of the nine tenths of places that fit best
  int attitude = 0;      ///< which of the eight it began from: 0, as the writing says
};

/// The vertices of a mesh in mm.
std::vector<glm::dvec3> points_mm(const TriMesh& mesh);

/// Begins with the tablet's own axes (find_tablet_frame()) in the eight attitudes that a box has: four ways up, two
/// obverses. From each, places of b spread evenly by area look for the nearest of a, the tenth that fits worst is left
/// out, and b goes where the planes there want it (motion_to_planes()); the best goes on with more places until it
/// rests (P. Besl, N. McKay: A method for registration of 3-D shapes, 1992; D. Chetverikov et al.: The trimmed
/// iterative closest point algorithm, 2002). Inferred triangles take no part. `b` may be a piece of `a` only if it has
/// most of it. Deterministic. kBadData: no triangles; kCancelled. `surface` is that of `a`.
Result<SurfaceAlignment> align_surfaces(const TriMesh& a, const NearestSurface& surface, const TriMesh& b,
                                        Progress& progress);

}  // namespace dubsar
