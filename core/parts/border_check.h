#pragma once
// Are bodies closed where they meet? Only what lies beside borders of partitions and beside patches is looked at: all
// else is as the dual surface is.

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/extract/triangulate.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Middles of the edges at vertices of borders and patches that not exactly two triangles of a body run along, once in
/// each direction; empty: the `bodies` (PartitionTable::body_of()) of a model whose dual surface is closed are closed
/// 2-manifolds. `surface`: triangulate() of its mesh, without face points. Patches inside a body count as MeshOptions
/// says: not. The same for any number of threads. About 0.2 us a triangle of patches.
std::vector<glm::vec3> open_borders(const SurfaceModel& model, const Triangulation& surface,
                                    std::span<const PartitionId> bodies);

}  // namespace dubsar
