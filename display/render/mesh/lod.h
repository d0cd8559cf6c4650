#pragma once
// Fewer triangles for small pictures: all vertices in one cell of a grid become one (Rossignac and Borrel 1993). Quick
// and coarse, for views while things move; core/mesh/simplify.h makes surfaces that are worth keeping.

#include "display/render/mesh/gpu_mesh.h"

namespace dubsar {

/// Vertices within one cube of `cell_mm`, of one partition and of one of six normal directions, become their mean;
/// shape, ambient light and colour come from the one nearest to it. Triangles that collapse or repeat are dropped. So
/// thin walls keep both sides, no vertex moves by more than a cell's diagonal, and boxes and partitions stay. May be
/// non-manifold. Deterministic. Cost: about 0.3 us a vertex.
PackedMesh cluster_vertices(const PackedMesh& mesh, double cell_mm);

/// The same in a hurry, for a first picture: the first vertex of a cell stands for all, normals differ only coarsely,
/// triangles may repeat. Cost: about 60 ns a vertex.
PackedMesh quick_clusters(const PackedMesh& mesh, double cell_mm);

/// Sorts the triangles of each partition into blocks of space and fills mesh.chunks, so that what lies outside of a
/// view can be left out. The picture stays the same. Cost: about 20 ns a triangle.
void sort_into_chunks(PackedMesh& mesh);

}  // namespace dubsar
