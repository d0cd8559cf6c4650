#pragma once
// Makes a smoothed model one that an EXA file stores compactly: its surface goes into the offsets of the active edges,
// so that the vertices follow from the samples again. Call it before measuring or exporting what will be saved.

#include <cstdint>
#include <span>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/parts/surface_model.h"
#include "core/relief/curvature/curvature.h"

namespace dubsar {

struct SettleOptions {
  float max_error = 1.0f / 16.0f;  ///< largest distance of a vertex from the surface before, grid steps; positive
  bool exact_normals = false;      ///< keep normals and curvatures (about 130 bits a vertex in the file)
  CurvatureMethod curvature = CurvatureMethod::kFit;
};

struct SettleStats {
  double mean_error_vox = 0.0, p95_error_vox = 0.0, max_error_vox = 0.0;  ///< vertex to surface before
  double escaped_fraction = 0.0;        ///< vertices that the offsets do not bring near enough
  double normal_error_deg = 0.0;        ///< mean angle between normals before and after
  double shape_changed_fraction = 0.0;  ///< vertices whose class of shape is another one
  std::int64_t touching_cells = 0;      ///< where polygons touch each other all the same (part_pieces())
};

/// Chooses offsets of samples.offset_bits such that the vertices that follow from them (build_quad_mesh) lie on the
/// surface of mesh.positions: none further than max_error, 95 % within half of it; the few that cannot escape to a
/// place of their own (kEscapeStep), inside its cell where the mesh is embedded; there those of cells of several pieces
/// whose polygons would cross do, too. Vertices slide along the surface by up to half a grid step. Then normals and
/// curvatures are those of recomputed_normals() and principal_curvatures(), where the model has any and exact_normals
/// is off, and shape classes those of the curvatures; settle_light() settles ambient light. All other attributes stay.
/// A settled model stays as it is, to the last bit, unless it crosses itself. kUsage: max_error is not positive.
/// Deterministic for any thread count; about 3 us a vertex and thread.
Result<SettleStats> settle_for_exa(SurfaceModel& model, const SettleOptions& options, Progress& progress);

/// A hash of the bits of positions, normals and curvatures, never 0: those that settle_for_exa() left are still there
/// where it is model.settled_sum. The same for any thread count.
std::uint64_t settled_sum(const SurfaceModel& model);

/// Vertex normals of the x-quads' normals after 7 iterations of filter_normals(), epsilon .03: on a phantom of 31 dB
/// their mean distance from the normals of 32 iterations before settling is .9 degrees (3.5 without the filter).
Result<std::vector<glm::vec3>> recomputed_normals(const QuadMesh& mesh, Progress& progress);

}  // namespace dubsar
