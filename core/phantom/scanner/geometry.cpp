#include "core/phantom/scanner/geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/numbers/angle.h"

namespace dubsar::phantom {

double ScanGeometry::fan_rad() const noexcept {
  return cone() ? std::atan(0.5 * static_cast<double>(columns) / source) : 0.0;
}

Result<ScanGeometry> make_geometry(const Dims& dims, double voxel_mm, const TurnOptions& o) {
  ScanGeometry g;
  g.dims = dims;
  g.voxel_mm = voxel_mm;
  g.views =
      o.views > 0
          ? o.views
          : static_cast<std::int64_t>(std::ceil(o.views_per_voxel * static_cast<double>(std::max(dims.x, dims.y))));
  g.full = o.full;
  g.axis_px = o.axis_px;
  g.start_rad = o.start_deg * kRadPerDeg;
  const double radius = 0.5 * std::hypot(static_cast<double>(dims.x), static_cast<double>(dims.y));
  double widest = radius, highest = 0.5 * static_cast<double>(dims.z);
  if (o.cone_deg > 0.0) {
    g.source = 0.5 * static_cast<double>(dims.z) / std::tan(o.cone_deg * kRadPerDeg);
    if (g.source < 1.2 * radius)
      return fail(ErrorKind::kUsage,
                  "phantom: with a cone of {} degrees the source stands in the object, {:.0f} voxels from the axis, "
                  "expected more than {:.0f}",
                  o.cone_deg, g.source, 1.2 * radius);
    widest = radius / std::sqrt(1.0 - radius * radius / (g.source * g.source));
    highest *= g.source / (g.source - radius);
  }
  const auto pixels = [&](double half, double panel_mm) {
    const auto all = static_cast<std::int64_t>(std::ceil(half + std::abs(o.axis_px))) * 2;
    return std::min(all, static_cast<std::int64_t>(panel_mm / voxel_mm) / 2 * 2);
  };
  g.columns = pixels(widest + 2.0, kPanelWidthMm);
  g.rows = o.cone_deg > 0.0 ? std::max<std::int64_t>(pixels(highest, kPanelHeightMm), 2) : dims.z;
  g.turn_rad = o.full ? 2.0 * std::numbers::pi : std::numbers::pi + 2.0 * g.fan_rad();
  return g;
}

}  // namespace dubsar::phantom
