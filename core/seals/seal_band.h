#pragma once
// A band of a surface laid flat at its own scale, with the relief of what was pressed into it.

#include <optional>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"
#include "core/mesh/writing/height_map.h"
#include "core/seals/flat_sheet.h"

namespace dubsar {

/// Where a seal was rolled: the middle line of the band from one end to the other, along the surface, as a person
/// points to it; and how high the band is.
struct SealStrip {
  glm::dvec3 from_mm{0.0}, to_mm{0.0};
  double height_mm = 17.0;
};

struct UnrollOptions {
  double step_mm = 0.0;  ///< of the raster; 0: half of the surface's usual edge, .05 to .25 mm
  double base_radius_mm =
      16.0;  ///< over which the surface is smoothed at most: a seal's length, wider than what breaks away
};

struct UnrolledBand {
  FlatSheet sheet;             ///< the smoothed surface under it, a point a millimetre
  HeightMap relief;            ///< mm over the smoothed surface; x along the strip, y to its left; NaN: not measured
  SheetDistortion distortion;  ///< of the sheet
  /// The place of the smoothed surface under a place of the raster, and back; nothing beside the sheet.
  std::optional<glm::dvec3> surface_mm(const glm::dvec2& flat_mm) const;
};

/// The middle line is the section of the smoothed surface by the plane through both ends that stands on it; from each
/// millimetre of it lines go to both sides, straight on the surface; the sheet that they make is laid flat
/// (lay_flat()). A cylinder or cone comes out without distortion, a pillow with the least; no axis is needed, so that
/// bands may run round edges. Each vertex goes to the place of the sheet whose normal it lies on, and triangles are
/// sampled on the raster: inferred ones, those that look away and those farther than 2.5 mm from the sheet take no
/// part.
///
/// kUsage: ends or height that make no band, a mesh without surface there.
Result<UnrolledBand> unroll(const TriMesh& mesh, const SealStrip& strip, const UnrollOptions& options = {});

}  // namespace dubsar
