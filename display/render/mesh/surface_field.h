#pragma once
// Figures of a surface that its colours can tell: integral invariants and curvatures, measured once and carried by its
// vertices, and the scales and colours that they are shown in.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/compare/surface_difference.h"
#include "core/mesh/tri_mesh.h"
#include "display/render/shading.h"

namespace dubsar {

/// Whether the map tells a figure.
constexpr bool is_field(ColorMap map) noexcept { return map >= ColorMap::kIntegral; }

/// What a vertex carries, 16 bits each, 32767 for 1: distance from a plane / 0.5, k_min and k_max * mm / 32, distance
/// from another surface / 2 mm, -32767 where it is not compared.
using CarriedField = std::array<std::int16_t, 4>;

/// What has to be measured for a look.
struct FieldNeeds {
  bool integral = false, curvature = false;
  bool difference = false;  ///< from another surface
  bool any() const noexcept { return integral || curvature || difference; }
  /// Whether this has all that `other` needs.
  bool covers(const FieldNeeds& other) const noexcept {
    return (integral || !other.integral) && (curvature || !other.curvature) && (difference || !other.difference);
  }
  /// What of this the other has not.
  FieldNeeds without(const FieldNeeds& other) const noexcept {
    return {integral && !other.integral, curvature && !other.curvature, difference && !other.difference};
  }
  FieldNeeds with(const FieldNeeds& other) const noexcept {
    return {integral || other.integral, curvature || other.curvature, difference || other.difference};
  }
  bool operator==(const FieldNeeds&) const = default;
};
FieldNeeds fields_needed(const Style& style);
FieldNeeds fields_needed(const Style& style, const OtherLook& other);

/// Of the vertices of a mesh.
struct SurfaceFields {
  FieldNeeds has;
  std::vector<CarriedField> values;  ///< one per vertex
  SurfaceDifference difference{};    ///< its figures; those of vertices are among `values`
};

/// Integral invariants with their default radius, curvatures, the difference from `other`, which is laid on `mesh`
/// (null: no difference). Threads. Errors of difference_of(); cancelled.
Result<SurfaceFields> measure_fields(const TriMesh& mesh, const FieldNeeds& needs, Progress& progress,
                                     const TriMesh* other = nullptr);

/// Both, of the same vertices: what `made` has, and what only `had` has.
SurfaceFields joined(SurfaceFields made, const SurfaceFields& had);

/// The figure of a map that a vertex carries: integral invariants as distance_from_plane(), curvatures in 1/mm and
/// 1/mm2, the shape index -1..1, the difference in mm, not a number where it is not compared.
double field_figure(ColorMap map, const CarriedField& carried);

/// What the colours of a map reach from and to; a higher contrast of the style brings the ends nearer.
struct FieldScale {
  std::string_view name, unit;  ///< "mean curvature", "1/mm"; no unit: empty
  double from = -1.0, to = 1.0;
};
FieldScale field_scale(const Style& style);

/// From the scale's lower end to its upper one.
std::array<Rgb8, kShapeRows> field_colors(const Style& style);
/// The colour of a figure.
Rgb8 field_color(const Style& style, double figure);

}  // namespace dubsar
