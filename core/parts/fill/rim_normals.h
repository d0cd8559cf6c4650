#pragma once
// Which way a patch leaves the rim of the hole that it closes.

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/parts/border_loops.h"
#include "core/parts/face_graph.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Unit normals that a patch continues beyond each edge of `loop`, indices into `edges`; empty where some are not
/// known. They are means over the faces behind the rim as far as the hole is wide, and at most a small share of the
/// surface: the very rim is rounded, and where tablet and envelope meet at the end of a gap, both lean towards each
/// other. What one of them continues would run into the other, so that the mean of the tablet's normal and the one
/// opposite the envelope's is taken. `bodies`: of each partition. Deterministic for any thread count.
std::vector<glm::vec3> rim_normals(const SurfaceModel& model, const FaceGraph& graph,
                                   std::span<const PartitionId> bodies, std::span<const BorderEdge> edges,
                                   std::span<const std::uint32_t> loop);

}  // namespace dubsar
