#pragma once
// The fat-cross: one picture of all six sides, unfolded as a tablet is turned about its horizontal axis, so that the
// text runs on. Obverse, lower edge, reverse and upper edge below each other, the left and right edges beside the
// obverse and again, turned by half, beside the reverse; below them a ruler. One scale for all of it.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "app/publish/sheet_legend.h"
#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image_io/image.h"
#include "core/mesh/tablet_frame.h"
#include "core/mesh/tri_mesh.h"
#include "display/render/shading.h"

namespace dubsar::app {

enum class TabletSide { kObverse, kReverse, kUpper, kLower, kLeft, kRight };
inline constexpr std::array kTabletSides{TabletSide::kObverse, TabletSide::kReverse, TabletSide::kUpper,
                                         TabletSide::kLower,   TabletSide::kLeft,    TabletSide::kRight};

struct FatCrossOptions {
  double dpi = 600.0;               ///< 50 to 4800
  Rgb8 ground{0, 0, 0};             ///< of the whole picture
  int gap_px = 100;                 ///< between sides, around the ruler, and at the margin
  Shading shading{};                ///< its background is not used
  int samples = 3;                  ///< samples x samples a pixel
  SheetLegend legend{};             ///< below the ruler
  LabelFont* font = nullptr;        ///< of the ruler and the text; none: no words
  std::vector<std::string> text{};  ///< lines at the right of the cross
};

struct FatCross {
  Image whole;                                   ///< RGB
  std::array<Image, kTabletSides.size()> sides;  ///< RGB, in the order of kTabletSides, without margins
  int ruler_mm = 0, ruler_px = 0;
};

/// Draws `mesh`, which must lie in the tablet's own axes (in_tablet_frame()). kUsage (dpi), and the errors of
/// PictureRenderer::render().
Result<FatCross> draw_fat_cross(const TriMesh& mesh, const FatCrossOptions& options, Progress& progress);

/// Where each picture of the cross lies, from the sizes of the sides; whole pixels, y down. Pure.
struct CrossPlace {
  int x = 0, y = 0;
  bool half_turned = false;
};
struct CrossLayout {
  int width = 0, height = 0;
  std::array<CrossPlace, 4> spine;  ///< obverse, lower edge, reverse, upper edge
  std::array<CrossPlace, 4> wings;  ///< left and right of the obverse; right and left edge beside the reverse
  CrossPlace ruler, legend;
};
struct PixelExtent {
  int width = 0, height = 0;
};
CrossLayout lay_out_cross(const std::array<PixelExtent, kTabletSides.size()>& sides, PixelExtent ruler, int gap_px,
                          PixelExtent legend = {});

/// Length of the ruler in mm for a tablet of this width: 10, 20 or 50, the longest that is not longer.
int ruler_length_mm(double tablet_width_mm);
/// The ruler with its label ("2 cm"), of exactly round(mm / 25.4 * dpi) pixels length.
/// No font: without words.
Image draw_ruler(int mm, double dpi, const Rgb8& ground, LabelFont* font);

}  // namespace dubsar::app
