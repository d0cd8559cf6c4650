#include "display/render/mesh/surface_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/relief/curvature/integral_invariants.h"
#include "core/relief/curvature/mesh_curvature.h"

namespace dubsar {
namespace {

constexpr double kMostDistance = 0.5, kMostCurvature = 32.0;  // as in shaders/field.glsl

std::int16_t carried(double value, double most) {
  if (!std::isfinite(value)) return 0;
  return static_cast<std::int16_t>(std::lround(std::clamp(value / most, -1.0, 1.0) * 32767));
}
double figure(std::int16_t value, double most) { return value / 32767.0 * most; }

}  // namespace

FieldNeeds fields_needed(const Style& style) {
  return {style.map == ColorMap::kIntegral,
          (is_field(style.map) && style.map != ColorMap::kIntegral) || style.radiance > 0};
}

FieldNeeds fields_needed(const Style& style, const OtherLook& other) {
  FieldNeeds out = fields_needed(style);
  if (!(other.share > 0)) return out;
  const FieldNeeds more = fields_needed(other.style);
  return {out.integral || more.integral, out.curvature || more.curvature};
}

Result<SurfaceFields> measure_fields(const TriMesh& mesh, const FieldNeeds& needs, Progress& progress) {
  SurfaceFields out{needs, std::vector<CarriedField>(mesh.positions.size(), CarriedField{})};
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
  return out;
}

SurfaceFields joined(SurfaceFields made, const SurfaceFields& had) {
  const FieldNeeds only = had.has.without(made.has);
  for (std::size_t v = 0; v < made.values.size(); ++v) {
    if (only.integral) made.values[v][0] = had.values[v][0];
    if (only.curvature) std::copy_n(&had.values[v][1], 2, &made.values[v][1]);
  }
  made.has = {made.has.integral || only.integral, made.has.curvature || only.curvature};
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
    default:
      return 0.0;
  }
}

}  // namespace dubsar
