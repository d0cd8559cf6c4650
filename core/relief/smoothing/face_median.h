#pragma once
// filter_normals() without lists of neighbours: faces are neighbours where they meet at a vertex, so each vertex adds
// what its faces pull at one another, once for each pair.

#include <glm/vec4.hpp>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/system/large_pages.h"
#include "core/extract/quad_mesh.h"
#include "core/relief/smoothing/normal_filter.h"

namespace dubsar {

/// The same passes as filter_normals() over FaceNeighbours of the mesh, to within rounding (and faces that share four
/// vertices count four times, not three); median_steps is 1. 2.5 times as fast with the lists counted, for few
/// iterations. Bit-identical for any thread count and SIMD width. Only error: cancelled.
Result<void> filter_face_normals(const QuadMesh& mesh, const NormalFilterOptions& options, LargeArray<glm::vec4>& faces,
                                 Progress& progress);

}  // namespace dubsar
