#pragma once
// Places where a wedge may be: the deep places of a surface, and what is seen around each.

#include <vector>

#include "core/script/imprint/imprint.h"
#include "core/script/tangent_patch.h"

namespace dubsar {

/// What is usual on a tablet, mm.
struct WedgeScale {
  double width_mm = 0.0, depth_mm = 0.0;
  double rounding = 0.0;  ///< of inner edges, widths
  double fitted = 1.0;    ///< median width of its fitted heads, usual widths; above 1 on coarse meshes
  double misfit = 0.0;    ///< of its wedges (PlacedImprint::misfit): noise, and how coarse the mesh is; 0: not known
  UsualImprint usual() const { return {depth_mm / width_mm, rounding}; }
};

/// A deep place: its foot on the writing surface, and the normal there.
struct DeepPlace {
  glm::dvec3 foot{0.0}, normal{0, 0, 1};
  double depth_mm = 0.0;
};

/// Local maxima of the depth below the writing surface, each once; at least `least_depth` (of the usual depth). Of
/// tiles [k * skip], all with skip 1. Order: that of the tiles.
std::vector<DeepPlace> deep_places(const PatchCells& cells, const WedgeScale& scale, double least_depth, int skip);

/// A place with the relief around it, in units of the usual width; x, y along right and up of its own patch.
struct WedgeSite {
  glm::dvec3 origin{0.0}, right{1, 0, 0}, up{0, 1, 0}, out{0, 0, 1};
  DepthSamples samples;     ///< within kSiteReach widths, nearer ones count more
  DepthSamples coarse;      ///< every second of them each way, without `others`
  double seen = 0.0;        ///< share of the window's weight that is known
  double x = 0.0, y = 0.0;  ///< the deepest place
};

inline constexpr double kSiteReach = 2.2;

WedgeSite wedge_site(const PatchCells& cells, const WedgeScale& scale, const DeepPlace& place);

}  // namespace dubsar
