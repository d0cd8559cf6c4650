#pragma once
// Principal curvatures of a triangle mesh in 1/mm: those that it brings from the scan, else estimated from its
// triangles.

#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// One entry per vertex, 1/mm; k_min <= k_max, convex > 0.
struct MeshCurvatures {
  std::vector<float> k_min, k_max;
};

/// k_min and k_max of the mesh over its grid step where it has them and its voxels are cubes. Else the curvature tensor
/// of each triangle from how the normals of its corners differ along its edges (least squares), turned into the tangent
/// planes of its vertices and averaged by area (S. Rusinkiewicz: Estimating curvatures and their derivatives on
/// triangle meshes, 2004). Vertices without triangles get 0. Deterministic. Errors: cancelled. Progress in triangles.
Result<MeshCurvatures> mesh_curvatures(const TriMesh& mesh, Progress& progress);

}  // namespace dubsar
