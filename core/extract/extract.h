#pragma once
// Isosurface extraction: table-driven 2-manifold dual marching cubes (paper sections 3.2 and 3.3;
// docs/manifold.md). Two steps: sample the volume (signs, face decisions, crossings), then build the mesh from the
// samples.

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/edge_index.h"
#include "core/extract/quad_mesh.h"
#include "core/extract/surface_samples.h"
#include "core/volume/slab_source.h"

namespace dubsar {

struct ExtractOptions {
  float isovalue = 0.0f;
  int offset_bits = 4;    ///< N, 1..16: crossings are stored with a largest error of 0.5 * 2^-N grid steps
  bool closed = true;     ///< close the surface at the volume boundary with flat caps
  std::int64_t slab = 0;  ///< slices read at once, 0: about 4 MiB; changes the speed, never the result
};

/// Reads the volume once, in slabs. Deterministic for any thread count and slab height. Progress in voxels.
Result<SurfaceSamples> sample_surface(SlabSource& source, const ExtractOptions& options, Progress& progress);

/// Vertices, x-quads and incidence from the samples alone: a pure function, used after extraction and after reading an
/// EXA file. kBadData when the samples contradict each other (check_samples), kTryAgain beyond 2^32 - 2 vertices or
/// incidences. Progress in voxels. Deterministic for any thread count.
///
/// Order of the x-quads, closed: first those of the edges inside the grid, so that quad q belongs to offsets[q]; then
/// those of the virtual edges, in canonical order on the grid extended by the layer (rows z = -1.., y = -1..; x =
/// -1..). Open: those edges inside the grid that lie in no boundary face of the volume, in canonical order; a vertex
/// whose remaining x-quads form several fans is doubled, one without any is dropped.
Result<QuadMesh> build_quad_mesh(const SurfaceSamples& samples, Progress& progress);
/// The same for who has the index of these samples.
Result<QuadMesh> build_quad_mesh(const SurfaceSamples& samples, const EdgeIndex& index, Progress& progress);

}  // namespace dubsar
