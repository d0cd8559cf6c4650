#include "display/render/mesh/surface_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/relief/curvature/integral_invariants.h"
#include "core/relief/curvature/mesh_curvature.h"

namespace dubsar {
namespace {

constexpr double kMostDistance = 0.5, kMostCurvature = 32.0, kMostApart = 2.0;  // as in shaders/field.glsl
constexpr double kDifferenceReach = 0.99;  // of kMostApart: what is farther is not the same tablet's
constexpr std::int16_t kNotCompared = -32767;

std::int16_t carried(double value, double most) {
  if (!std::isfinite(value)) return 0;
  return static_cast<std::int16_t>(std::lround(std::clamp(value / most, -1.0, 1.0) * 32767));
}
double figure(std::int16_t value, double most) { return value / 32767.0 * most; }

}  // namespace

FieldNeeds fields_needed(const Style& style) {
  return {style.map == ColorMap::kIntegral,
          (is_field(style.map) && style.map != ColorMap::kIntegral && style.map != ColorMap::kDifference) ||
              style.radiance > 0,
          style.map == ColorMap::kDifference};
}

FieldNeeds fields_needed(const Style& style, const OtherLook& other) {
  FieldNeeds out = fields_needed(style);
  return other.share > 0 ? out.with(fields_needed(other.style)) : out;
}

Result<SurfaceFields> measure_fields(const TriMesh& mesh, const FieldNeeds& needs, Progress& progress,
                                     const TriMesh* other) {
  SurfaceFields out{needs, std::vector<CarriedField>(mesh.positions.size(), CarriedField{}), {}};
  if (needs.curvature) {
    DUBSAR_ASSIGN(const MeshCurvatures k, mesh_curvatures(mesh, progress));
    for (std::size_t v = 0; v < out.values.size(); ++v) {
      out.values[v][1] = carried(k.k_min[v], kMostCurvature);
      out.values[v][2] = carried(k.k_max[v], kMostCurvature);
    }
  }
  if (needs.integral) {
    DUBSAR_ASSIGN(const auto shares, integral_invariants(mesh, default_invariant_radius_mm(mesh), progress));
    for (std::size_t v = 0; v < out.values.size(); ++v)
      out.values[v][0] = carried(distance_from_plane(shares[v]), kMostDistance);
  }
  out.has.difference = needs.difference && other != nullptr;
  if (out.has.difference) {
    DUBSAR_ASSIGN(out.difference, difference_of(*other, mesh, kDifferenceReach * kMostApart, progress));
    const std::vector<double> apart_mm = std::exchange(out.difference.vertex_mm, {});
    for (std::size_t v = 0; v < out.values.size(); ++v)
      out.values[v][3] = std::isnan(apart_mm[v]) ? kNotCompared : carried(apart_mm[v], kMostApart);
  }
  return out;
}

SurfaceFields joined(SurfaceFields made, const SurfaceFields& had) {
  const FieldNeeds only = had.has.without(made.has);
  for (std::size_t v = 0; v < made.values.size(); ++v) {
    if (only.integral) made.values[v][0] = had.values[v][0];
    if (only.curvature) std::copy_n(&had.values[v][1], 2, &made.values[v][1]);
    if (only.difference) made.values[v][3] = had.values[v][3];
  }
  if (only.difference) made.difference = had.difference;
  made.has = made.has.with(only);
  return made;
}

double field_figure(ColorMap map, const CarriedField& c) {
  const double low = figure(c[1], kMostCurvature), high = figure(c[2], kMostCurvature);
  switch (map) {
    case ColorMap::kIntegral:
      return figure(c[0], kMostDistance);
    case ColorMap::kMean:
      return 0.5 * (low + high);
    case ColorMap::kGaussian:
      return low * high;
    case ColorMap::kShapeIndex:
      return low == 0.0 && high == 0.0 ? 0.0 : std::atan2(low + high, high - low) * 2.0 / std::numbers::pi;
    case ColorMap::kCurvedness:
      return std::sqrt(0.5 * (low * low + high * high));
    case ColorMap::kDifference:
      return c[3] == kNotCompared ? std::numeric_limits<double>::quiet_NaN() : figure(c[3], kMostApart);
    default:
      return 0.0;
  }
}

}  // namespace dubsar
