#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/phantom/scanner/projector.h"
#include "core/phantom/scanner/ramp_filter.h"
#include "core/phantom/scanner/ray_kernels.h"

namespace dubsar::phantom {
namespace {

constexpr std::int64_t kViewsAtATime = 24;  ///< whose filtered columns stay in the caches of a machine of today

/// Parker's weights of a short scan: those of the two rays along one line add up to 1.
double parker(double turned, double fan, double half_fan) {
  const double quarter = 0.25 * std::numbers::pi, pi = std::numbers::pi;
  const auto squared = [](double x) { return std::sin(x) * std::sin(x); };
  if (turned < 2.0 * (half_fan + fan)) return squared(quarter * turned / (half_fan + fan));
  if (turned > pi + 2.0 * fan) return squared(quarter * (pi + 2.0 * half_fan - turned) / (half_fan - fan));
  return 1.0;
}

/// One view times the weights of its rays; what is beyond the last row is 0.
void weigh(const Columns& projections, const ScanGeometry& g, std::int64_t view, std::vector<float>& out) {
  out.assign(static_cast<std::size_t>(projections.columns * projections.stride), 0.0f);
  for (std::int64_t column = 0; column < g.columns; ++column) {
    const float* from = projections.at(view, column);
    float* to = out.data() + column * projections.stride;
    if (!g.cone()) {
      std::copy_n(from, g.rows, to);
      continue;
    }
    const double u = g.u_of(static_cast<double>(column)), r = g.source;
    const double short_scan = g.full ? 1.0 : parker(g.angle(view) - g.start_rad, std::atan(u / r), g.fan_rad());
    for (std::int64_t row = 0; row < g.rows; ++row) {
      const double v = g.v_of(static_cast<double>(row));
      to[row] = from[row] * static_cast<float>(short_scan * r / std::sqrt(r * r + u * u + v * v));
    }
  }
}

/// How a view is seen from a column of voxels at (x, y): which two filtered columns, and where along them.
struct ViewOfColumn {
  double cosine, sine;
  const float* filtered;
};

}  // namespace

Result<Columns> reconstruct(const Columns& projections, const ScanGeometry& g, Window window, Progress& progress) {
  Columns out(g.dims.x, g.dims.y, g.dims.z);
  out.clear();
  const RampFilter ramp(g.columns, g.voxel_mm, window);
  const std::int64_t stride = projections.stride, view_size = ramp.columns_out() * stride;
  Buffer<float> filtered(kViewsAtATime * view_size + Columns::kGuard);
  const double share = (g.full ? 0.5 : 1.0) * g.turn_rad / static_cast<double>(g.views);
  const double x_middle = 0.5 * static_cast<double>(g.dims.x - 1), y_middle = 0.5 * static_cast<double>(g.dims.y - 1);
  const double z_middle = 0.5 * static_cast<double>(g.dims.z - 1);
  progress.begin("reconstruct", g.views, "view");
  for (std::int64_t first = 0; first < g.views && !progress.cancelled(); first += kViewsAtATime) {
    const std::int64_t count = std::min(kViewsAtATime, g.views - first);
    std::vector<ViewOfColumn> views;
    for (std::int64_t k = 0; k < count; ++k)
      views.push_back({std::cos(g.angle(first + k)), std::sin(g.angle(first + k)), filtered.data() + k * view_size});
    parallel_for(count, 1, [&](std::int64_t k) {
      thread_local std::vector<float> weighed;
      weigh(projections, g, first + k, weighed);
      ramp.apply(weighed.data(), stride, filtered.data() + k * view_size);
    });
    parallel_for(g.dims.x * g.dims.y, 64, [&](std::int64_t item) {
      thread_local std::vector<kernels::Tap> taps;
      taps.clear();
      const double x = static_cast<double>(item / g.dims.y) - x_middle,
                   y = static_cast<double>(item % g.dims.y) - y_middle;
      for (const ViewOfColumn& view : views) {
        const double s = x * view.cosine + y * view.sine, t = y * view.cosine - x * view.sine;
        const double scale = g.cone() ? g.source / (g.source - s) : 1.0;
        const double place = 2.0 * (t * scale + 0.5 * static_cast<double>(g.columns - 1));
        const double base = std::floor(place);
        if (base < 0.0 || base + 2.0 > static_cast<double>(2 * g.columns - 1)) continue;  // beside the panel
        const double weight = share * scale * scale, part = place - base;
        const float* column = view.filtered + static_cast<std::int64_t>(base) * stride;
        taps.push_back(
            {column, column + stride, static_cast<float>(weight * (1.0 - part)), static_cast<float>(weight * part),
             static_cast<float>(0.5 * static_cast<double>(g.rows - 1) - z_middle * scale), static_cast<float>(scale)});
      }
      const std::span<float> rows(out.values.data() + item * out.stride, static_cast<std::size_t>(out.stride));
      if (g.cone())
        kernels::sum_magnified(taps, static_cast<float>(g.rows - 1), rows);
      else
        kernels::sum_straight(taps, rows);
    });
    progress.advance(count);
  }
  progress.end();
  if (progress.cancelled()) return cancelled_error();
  return out;
}

}  // namespace dubsar::phantom
