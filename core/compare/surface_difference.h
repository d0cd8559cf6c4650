#pragma once
// How far one surface lies from another, with its sign, in figures and colours.

#include <array>
#include <cstdint>
#include <vector>

#include "core/compare/surface_alignment.h"

namespace dubsar {

struct SurfaceDifference {
  SurfaceAlignment alignment;
  std::vector<double> vertex_mm;  ///< of each vertex of b: more than 0 where b lies outside a; NaN: not compared
  double compared_mm2 = 0.0;      ///< of b
  double left_out_mm2 = 0.0;      ///< of b: inferred in one of the two, or nothing of a within reach_mm
  double mean_mm = 0.0, rms_mm = 0.0, median_mm = 0.0;  ///< weighted by area; median: of the amounts
  double most_mm = 0.0;                                 ///< amount that a hundredth of the area exceeds
  double within_05 = 0.0, within_10 = 0.0;              ///< shares of the area within .05 and .1 mm
};

/// Aligned first (align_surfaces()). Inferred surface of either takes no part. `reach_mm`: what is farther away than
/// that was lost, or is not the same. Errors of align_surfaces().
Result<SurfaceDifference> difference_of(const TriMesh& a, const TriMesh& b, double reach_mm, Progress& progress);

/// Blue where clay is missing, white where nothing changed, red where there is more, full at `range_mm`; grey: not
/// compared.
std::array<std::uint8_t, 3> difference_color(double mm, double range_mm);

}  // namespace dubsar
