#include "core/phantom/scanner/projector.h"

#include <cmath>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/phantom/scanner/ray_kernels.h"

namespace dubsar::phantom {
namespace {

using kernels::Tap;

/// Columns along z that hold anything.
std::vector<std::uint8_t> filled_columns(const Columns& object) {
  std::vector<std::uint8_t> filled(static_cast<std::size_t>(object.planes * object.columns));
  parallel_for(static_cast<std::int64_t>(filled.size()), 256, [&](std::int64_t i) {
    const float* column = object.values.data() + i * object.stride;
    filled[static_cast<std::size_t>(i)] =
        std::any_of(column, column + object.rows, [](float value) { return value != 0.0f; });
  });
  return filled;
}

/// The ray of one column of pixels: in the plane of its pixels it is one line.
struct Ray {
  double x, y, dx, dy;  ///< the point (x, y) + s (dx, dy) is s towards the source from the plane of the axis
};

struct RayTracer {
  const Columns& object;
  const ScanGeometry& geometry;
  const std::vector<std::uint8_t>& filled;

  Ray ray(double angle, double u) const {
    const double c = std::cos(angle), s = std::sin(angle), slope = geometry.cone() ? u / geometry.source : 0.0;
    return {-u * s, u * c, c + slope * s, s - slope * c};
  }

  // Planes of constant x, or of constant y: `along` is the axis that the ray runs along most.
  void taps(const Ray& ray, std::vector<Tap>& out) const {
    out.clear();
    const bool along_x = std::abs(ray.dx) >= std::abs(ray.dy);
    const std::int64_t planes = along_x ? object.planes : object.columns;
    const std::int64_t across = along_x ? object.columns : object.planes;
    const double middle = 0.5 * static_cast<double>(planes - 1), aside = 0.5 * static_cast<double>(across - 1);
    const double from = along_x ? ray.x : ray.y, rate = along_x ? ray.dx : ray.dy;
    const double other = along_x ? ray.y : ray.x, other_rate = along_x ? ray.dy : ray.dx;
    const double z_middle = 0.5 * static_cast<double>(object.rows - 1), v_first = geometry.v_of(0.0);
    for (std::int64_t plane = 0; plane < planes; ++plane) {
      const double s = (static_cast<double>(plane) - middle - from) / rate;
      const double place = other + s * other_rate + aside;
      const double base = std::floor(place);
      const auto first = static_cast<std::int64_t>(base);
      if (first < -1 || first >= across) continue;
      const auto index = [&](std::int64_t k) {
        return along_x ? plane * object.columns + k : k * object.columns + plane;
      };
      const std::int64_t a = std::max<std::int64_t>(first, 0), b = std::min(first + 1, across - 1);
      if (!filled[static_cast<std::size_t>(index(a))] && !filled[static_cast<std::size_t>(index(b))]) continue;
      const auto t = static_cast<float>(place - base);
      Tap tap{object.values.data() + index(a) * object.stride, object.values.data() + index(b) * object.stride,
              first < 0 ? 0.0f : 1.0f - t, first + 1 >= across ? 0.0f : t};
      if (geometry.cone()) {  // seen from the source, the rows lie closer behind the axis and wider before it
        const double scale = (geometry.source - s) / geometry.source;
        tap.start = static_cast<float>(z_middle + v_first * scale);
        tap.step = static_cast<float>(scale);
      }
      out.push_back(tap);
    }
  }

  /// Millimetres between two planes in the middle plane of the cone.
  double step_mm(const Ray& ray) const {
    return geometry.voxel_mm * std::hypot(ray.dx, ray.dy) / std::max(std::abs(ray.dx), std::abs(ray.dy));
  }
};

}  // namespace

Result<Columns> project(const Columns& object, const ScanGeometry& g, Progress& progress) {
  Columns out(g.views, g.columns, g.rows);
  const std::vector<std::uint8_t> filled = filled_columns(object);
  const RayTracer tracer{object, g, filled};
  progress.begin("project", g.views, "view");
  parallel_for(g.views, 1, [&](std::int64_t view) {
    if (progress.cancelled()) return;
    thread_local std::vector<Tap> taps;
    for (std::int64_t column = 0; column < g.columns; ++column) {
      const double u = g.u_of(static_cast<double>(column)) + g.axis_px;
      const Ray ray = tracer.ray(g.angle(view), u);
      tracer.taps(ray, taps);
      float* to = out.at(view, column);
      const std::span<float> rows(to, static_cast<std::size_t>(out.stride));
      std::fill(rows.begin(), rows.end(), 0.0f);
      if (g.cone())
        kernels::sum_magnified(taps, static_cast<float>(object.rows - 1), rows);
      else
        kernels::sum_straight(taps, rows);
      const double step = tracer.step_mm(ray);
      const double plane2 = g.cone() ? g.source * g.source + u * u : 1.0;
      for (std::int64_t row = 0; row < g.rows; ++row) {
        const double v = g.cone() ? g.v_of(static_cast<double>(row)) : 0.0;  // out of the middle plane
        to[row] *= static_cast<float>(step * std::sqrt(1.0 + v * v / plane2));
      }
    }
    progress.advance(1);
  });
  progress.end();
  if (progress.cancelled()) return cancelled_error();
  return out;
}

}  // namespace dubsar::phantom
