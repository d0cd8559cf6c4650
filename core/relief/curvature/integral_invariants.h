#pragma once
// Multi-scale integral invariants of a surface (H. Pottmann, J. Wallner, Q.-X. Huang, Y.-L. Yang: Integral invariants
// for robust geometry processing, 2009; as a filter for cuneiform H. Mara, S. Kroemker, S. Jakob, B. Breuckmann:
// GigaMesh and Gilgamesh, 2010): how much of a ball around each vertex lies inside of its body, at several radii.

#include <array>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

constexpr std::size_t kInvariantScales = 4;  ///< radii of 1/4, 1/2, 3/4 and 1 of the largest
/// Shares of the balls' volumes, smallest ball first: 1/2 on a plane, less where the surface is convex.
using InvariantShares = std::array<float, kInvariantScales>;

/// 1 mm, which is about the width of a wedge's head, and at least four mean edges; twelve mean edges where the mesh
/// does not say how long a millimetre is.
double default_invariant_radius_mm(const TriMesh& mesh);

/// One entry per vertex. The volumes are integrals over the surface: with x from the vertex to a place of it and n its
/// normal, the share is W / 4 pi - 1 / 4 pi * integral of x.n (1 / |x|^3 - 1 / r^3) dA over what lies in the ball
/// (divergence theorem for x (1 - r^3 / |x|^3) / 3, which is tangent to the ball); W is the solid angle that the
/// triangles at the vertex enclose. Bodies (Partition::body_name) do not see each other; a border counts as if the
/// surface went on smoothly. Triangles count with their centres; beyond a quarter of the largest radius those within
/// cells of 1/24 of it count as one, beyond half of it those within 1/12, so that fine meshes cost little more.
/// Threads; deterministic for any number of them. Cost: about 3 us a vertex and core. Progress in vertices. Errors:
/// kUsage (radius), cancelled.
Result<std::vector<InvariantShares>> integral_invariants(const TriMesh& mesh, double radius_mm, Progress& progress);

/// How far the shares are from those of a plane, root mean square over the scales: 0 plane, positive convex, negative
/// concave, at most 1/2.
float distance_from_plane(const InvariantShares& shares) noexcept;

}  // namespace dubsar
