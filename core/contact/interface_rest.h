#pragma once
// What is left open between the traced contact and the surface beside it: tiny loops where cells hold several surfaces,
// and wider ones where the band ends.

#include <cstdint>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/interface_mesh.h"
#include "core/parts/face_graph.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Closes every loop of sides of tablet, envelope and contact that do not pair up: a tiny one with a star around a new
/// vertex, a wider one with a smooth patch (loop_fill.h). Returns the number of loops. kCancelled.
Result<std::int64_t> close_rest(const SurfaceModel& model, const FaceGraph& graph, InterfaceMesh& mesh,
                                Progress& progress);

/// Where the contact runs along an edge of the surface that tablet or envelope has already on both sides, or twice
/// along an edge of its own, its two triangles get a vertex of their own in the middle, a little apart.
void part_shared_edges(const SurfaceModel& model, InterfaceMesh& mesh);

/// Where the contact touches itself at an added vertex, every fan but the first gets one of its own, a little apart:
/// readers of files without numbers of vertices would join them. O(triangles).
void part_fans(std::uint32_t first_added, InterfaceMesh& mesh);

}  // namespace dubsar
