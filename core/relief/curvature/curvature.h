#pragma once
// Principal curvatures of the dual mesh (paper section 3.4.2).

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

enum class CurvatureMethod {
  kFit,  ///< least-squares shape operator of all incident x-quads: also right where the quads lie across the curvature
  kPairs,  ///< the paper's: extremes of the two diagonals of each x-quad, vector median over the incident x-quads
};

/// One entry per vertex, per grid step; k_min <= k_max, convex > 0, concave < 0.
struct Curvatures {
  std::vector<float> k_min, k_max;
};

/// `normals`: one unit vector towards the air per vertex. The curvature between two points is
/// (n2 - n1).(p2 - p1) / |p2 - p1|^2; a doubled corner counts with the mean of its two vertices.
/// kFit solves min sum |S u - dn|^2 over the symmetric S in the tangent plane of the vertex, where u and dn are the
/// projected differences of positions and normals between both pairs of opposite corners and both pairs of opposite
/// edge middles of each incident x-quad; vertices without extent get 0.
/// Deterministic for any thread count. Only error: cancelled. Progress in vertices.
Result<Curvatures> principal_curvatures(const QuadMesh& mesh, std::span<const glm::vec3> normals,
                                        CurvatureMethod method, Progress& progress);

}  // namespace dubsar
