#pragma once
// The seal as a picture in raking light at true scale, and as a surface to measure or print.

#include "core/image_io/image.h"
#include "core/mesh/tri_mesh.h"
#include "core/seals/relief_level.h"

namespace dubsar {

struct SealPictureOptions {
  double dpi = 600.0;
  bool as_stone = false;  ///< mirrored and sunk, as the seal was cut; else as its impressions are
  bool hatch = true;      ///< what nothing shows; else the ground's gray
};

/// Gray, lit from the upper left at 30 degrees; what no impression shows is hatched. 25.4 mm are dpi pixels.
Image draw_seal(const SealImpression& relief, const SealPictureOptions& options);

/// A surface of one vertex a place of the raster, mm, x along the rolling, heights along z; holes where nothing is
/// shown.
TriMesh seal_surface(const SealImpression& relief, bool as_stone);

}  // namespace dubsar
