#pragma once
// The grid edge of each x-quad, and the cell of each dual vertex: where in the grid a mesh lies.

#include <glm/vec3.hpp>
#include <vector>

#include "core/extract/edge_index.h"
#include "core/extract/labelled/contact_edges.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

/// Of the x-quads of build_quad_mesh() of closed samples, in their order. All threads; 16 bytes an x-quad.
std::vector<GridEdge> edges_of_quads(const BitVolume& signs, const EdgeIndex& index);

/// The cell of each vertex: it lies between this point of the grid, from -1 on, and one step along each axis.
/// `reversed[q]`: of x-quad q the end with the lower label, or the air, is the edge's first.
std::vector<glm::ivec3> cells_of_vertices(const QuadMesh& mesh, const std::vector<GridEdge>& edges,
                                          const std::vector<bool>& reversed);

}  // namespace dubsar
