#pragma once
// Where source, axis and panel stand. Lengths in voxels, seen at the axis of rotation (the panel divided by the
// magnification); the axis is parallel to z, through the middle of the grid.
//
// A view at angle b has the unit vectors s = (cos b, sin b) towards the source and t = (-sin b, cos b) along the rows
// of the panel. The ray of a pixel at (u, v) goes through the point u t + v z of the plane of the axis: parallel to s,
// or from the source at `source` s.

#include <cstdint>

#include "core/phantom/scanner/scanner_options.h"
#include "core/volume/volume.h"

namespace dubsar::phantom {

/// The panel of the paper's instrument, 3072x1944 pixels of 74.8 um, at the magnification of its voxel of 38 um: what
/// it sees of the plane of the axis, mm. Pixels are binned to one voxel there.
inline constexpr double kPanelWidthMm = 3072 * 0.038, kPanelHeightMm = 1944 * 0.038;
inline constexpr double kMagnification = 0.0748 / 0.038;

struct ScanGeometry {
  Dims dims;
  double voxel_mm = 1.0;
  std::int64_t views = 0, columns = 0, rows = 0;
  double source = 0.0;  ///< from the axis; 0: infinitely far, parallel rays
  double start_rad = 0.0, turn_rad = 0.0;
  bool full = true;
  double axis_px = 0.0;  ///< the ray of a column goes through u + axis_px in truth

  bool cone() const noexcept { return source > 0.0; }
  double u_of(double column) const noexcept { return column - 0.5 * static_cast<double>(columns - 1); }
  double v_of(double row) const noexcept { return row - 0.5 * static_cast<double>(rows - 1); }
  double angle(std::int64_t view) const noexcept {
    return start_rad + turn_rad * (static_cast<double>(view) + 0.5) / static_cast<double>(views);
  }
  /// Half the angle of the fan, radians.
  double fan_rad() const noexcept;
};

/// kUsage: the source would stand within the object.
Result<ScanGeometry> make_geometry(const Dims& dims, double voxel_mm, const TurnOptions& options);

}  // namespace dubsar::phantom
