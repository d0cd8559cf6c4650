#pragma once
// A grid whose rays are made straight: f' = f + R^-1 (g(p) / c1 - p), p = R f. Only the difference goes through the
// projector, so that nothing of the rest is blurred (method `rays`).

#include <memory>

#include "core/base/progress.h"
#include "core/rays/axis_shift.h"
#include "core/rays/lane_planes.h"
#include "core/rays/ray_curve.h"
#include "core/rays/scatter_field.h"
#include "core/volume/grid_store.h"

namespace dubsar {

struct StraightenOptions {
  TurnAxis axis = TurnAxis::kZ;
  GreyLevels levels;
  RayCurve curve;                                  ///< lengths in voxels of the grid
  std::shared_ptr<const ScatterField> stray = {};  ///< in voxels of the grid, where the curve has a part by scatter
};

struct Straightened {
  AxisShift axis_shift;  ///< that was found, in voxels of the grid, and undone
};

/// Crossings of voxels and rays that straightening takes: what its time goes by (CurveSearch::crossings).
double crossings_of(const Dims& grid, TurnAxis axis) noexcept;

/// The shift of an axis of rotation that was off, in some planes of the middle; of a grid on the disk about z only.
/// Errors: those of the grid.
Result<AxisShift> find_shift_in(GridStore& grid, const StraightenOptions& options);

/// In place. An axis of rotation that is off in a scan of half a turn is found in some planes of the middle, and rays
/// are moved back before they are straightened. Advances `progress` by voxels. Memory: some kLanes planes, twice. A
/// grid on the disk can be straightened about z only. Errors: kTryAgain for the other axes there, those of the grid,
/// kCancelled.
Result<Straightened> straighten(GridStore& grid, const StraightenOptions& options, Progress& progress);

}  // namespace dubsar
