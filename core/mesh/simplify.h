#pragma once
// Adaptive vertex clustering (paper section 3.3): fewer triangles where the surface is flat, still a 2-manifold.

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct SimplifyOptions {
  double max_angle_rad = 0.35;    ///< between a triangle and any original triangle it stands for
  double max_distance_vox = 0.1;  ///< between the surfaces, either way, in grid steps
};

/// Merges vertices into neighbours until a criterion stops it. Vertices of the result are vertices of the mesh, with
/// all their attributes; frame, parts and provenance are copied. Guarantees:
/// - a 2-manifold stays one, with the same components and Euler numbers (link condition);
/// - the Hausdorff distance of the surfaces is at most max_distance_vox: each merge maps the triangles around a vertex
///   one-to-one to those that replace them, along one direction, and the lengths of these maps are added up (the sum
///   overestimates: curved regions keep about three times the triangles that the distance alone would need);
/// - vertices of boundaries and of part borders, and vertices at one place (where parts mate) are kept;
/// - deterministic. One thread, about 10 us a vertex.
/// kUsage for options out of range, kBadData for triangles that name missing vertices. Progress in vertices, all passes
/// together.
Result<TriMesh> simplify(const TriMesh& mesh, const SimplifyOptions& options, Progress& progress);

}  // namespace dubsar
