#include "app/publish/fat_cross.h"

#include <algorithm>
#include <cstring>

#include "core/base/system/budget.h"
#include "display/render/images/label_text.h"
#include "display/render/images/render_image.h"

namespace dubsar::app {
namespace {

/// From where each side is seen, in the order of kTabletSides, when x is right, y up and z out of the obverse.
constexpr std::array<ViewDirection, kTabletSides.size()> kViews{{
    {0, 0, 0},      // obverse
    {180, 0, 180},  // reverse: over the lower edge, so that its text is upright
    {0, 90, 0},     // upper edge, the reverse's side up
    {0, -90, 0},    // lower edge, the obverse's side up
    {-90, 0, 0},    // left edge, the obverse's side to the right
    {90, 0, 0},     // right edge, the obverse's side to the left
}};

std::size_t index(TabletSide side) { return static_cast<std::size_t>(side); }

void paste(const Image& part, const CrossPlace& place, Image& whole) {
  for (int y = 0; y < part.height; ++y)
    std::memcpy(whole.at(place.x, place.y + y), part.at(0, y), static_cast<std::size_t>(part.width) * 3);
}

/// The text of the tablet in letters of 2.5 mm.
Image text_beside(const FatCrossOptions& options) {
  if (options.font == nullptr || options.text.empty()) return {};
  const bool dark = options.ground[0] + options.ground[1] + options.ground[2] < 384;
  return text_block(*options.font, options.text, std::max(10.0, 2.5 / 25.4 * options.dpi), options.ground,
                    dark ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0});
}

/// What one picture of several says of its progress: nothing, for the whole is one stage, but it stops when that is
/// stopped.
class OneOfSeveral final : public Progress {
 public:
  explicit OneOfSeveral(const Progress& whole) : whole_(whole) {}

 protected:
  void on_begin(std::string_view, std::int64_t, std::string_view) override { look(); }
  void on_advance(std::int64_t) override { look(); }

 private:
  void look() {
    if (whole_.cancelled()) cancel();
  }
  const Progress& whole_;
};

}  // namespace

CrossLayout lay_out_cross(const std::array<PixelExtent, kTabletSides.size()>& sides, PixelExtent ruler, int gap,
                          PixelExtent legend) {
  const auto of = [&](TabletSide side) { return sides[index(side)]; };
  const std::array spine{TabletSide::kObverse, TabletSide::kLower, TabletSide::kReverse, TabletSide::kUpper};
  const int wing = std::max(of(TabletSide::kLeft).width, of(TabletSide::kRight).width);
  int column = ruler.width;
  for (const TabletSide side : spine) column = std::max(column, of(side).width);
  CrossLayout out;
  out.width = std::max(column + 2 * wing + 4 * gap, legend.width + 2 * gap);
  const int middle = out.width / 2;
  int y = gap;
  for (std::size_t k = 0; k < spine.size(); ++k) {
    out.spine[k] = {middle - of(spine[k]).width / 2, y, false};
    y += of(spine[k]).height + gap;
  }
  out.ruler = {middle - ruler.width / 2, y, false};
  out.height = y + ruler.height + gap;
  out.legend = {middle - legend.width / 2, out.height, false};
  if (legend.height > 0) out.height += legend.height + gap;
  const int left_end = middle - column / 2 - gap, right_begin = middle + (column + 1) / 2 + gap;
  const auto beside = [&](std::size_t row, TabletSide side, bool left, bool half_turned) {
    const PixelExtent extent = of(side);
    const int centre = out.spine[row].y + of(spine[row]).height / 2;
    return CrossPlace{left ? left_end - extent.width : right_begin, std::max(0, centre - extent.height / 2),
                      half_turned};
  };
  // Turned over its lower edge, the tablet has its left edge still at the left, upside down.
  out.wings = {beside(0, TabletSide::kLeft, true, false), beside(0, TabletSide::kRight, false, false),
               beside(2, TabletSide::kLeft, true, true), beside(2, TabletSide::kRight, false, true)};
  return out;
}

Result<FatCross> draw_fat_cross(const TriMesh& mesh, const FatCrossOptions& options, Progress& progress) {
  if (!(options.dpi >= 50 && options.dpi <= 4800))
    return fail(ErrorKind::kUsage, "fatcross: {} dots an inch found, expected 50 to 4800", options.dpi);
  DUBSAR_ASSIGN(PictureRenderer renderer, PictureRenderer::create(mesh));
  FatCross cross;
  RenderOptions render;
  render.shading = options.shading;
  render.shading.background = {options.ground, false};
  render.samples = options.samples;
  render.camera.object = ObjectFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  render.camera.margin = 0.0;
  render.camera.mm_per_pixel = 25.4 / options.dpi;
  render.camera.width = render.camera.height = 0;
  const auto draw = [&](const ViewDirection& direction) -> Result<Image> {
    render.camera.direction = direction;
    OneOfSeveral one(progress);
    DUBSAR_ASSIGN(Picture picture, renderer.render(render, one));
    progress.advance(1);
    return std::move(picture.image);
  };
  DUBSAR_TRY(renderer.prepare(options.shading, progress));
  progress.begin("draw the sides", static_cast<std::int64_t>(kTabletSides.size()), "side");
  std::array<PixelExtent, kTabletSides.size()> extents;
  for (const TabletSide side : kTabletSides) {
    Image& image = cross.sides[index(side)];
    DUBSAR_ASSIGN(image, draw(kViews[index(side)]));
    extents[index(side)] = {image.width, image.height};
  }
  progress.end();
  cross.ruler_mm = ruler_length_mm(renderer.box_mm().size().x);
  const Image ruler = draw_ruler(cross.ruler_mm, options.dpi, options.ground, options.font);
  cross.ruler_px = ruler.width;
  const int width = lay_out_cross(extents, {ruler.width, ruler.height}, options.gap_px).width;
  DUBSAR_ASSIGN(const Image legend, draw_sheet_legend(options.shading.style, options.legend, options.dpi,
                                                      width - 2 * options.gap_px, options.ground));
  CrossLayout layout =
      lay_out_cross(extents, {ruler.width, ruler.height}, options.gap_px, {legend.width, legend.height});
  const Image text = text_beside(options);
  const CrossPlace text_place{layout.width, options.gap_px, false};
  if (text.width > 0) {
    layout.width += text.width + options.gap_px;
    layout.height = std::max(layout.height, text.height + 2 * options.gap_px);
  }
  DUBSAR_TRY(check_memory("fatcross",
                          static_cast<std::uint64_t>(layout.width) * static_cast<std::uint64_t>(layout.height) * 3));
  cross.whole = Image(layout.width, layout.height, 3);
  for (std::size_t i = 0; i < cross.whole.pixels.size(); i += 3)
    std::copy(options.ground.begin(), options.ground.end(),
              cross.whole.pixels.begin() + static_cast<std::ptrdiff_t>(i));
  const auto picture = [&](TabletSide side) -> const Image& { return cross.sides[index(side)]; };
  paste(picture(TabletSide::kObverse), layout.spine[0], cross.whole);
  paste(picture(TabletSide::kLower), layout.spine[1], cross.whole);
  paste(picture(TabletSide::kReverse), layout.spine[2], cross.whole);
  paste(picture(TabletSide::kUpper), layout.spine[3], cross.whole);
  for (std::size_t k = 0; k < layout.wings.size(); ++k) {
    const TabletSide side = k % 2 == 0 ? TabletSide::kLeft : TabletSide::kRight;
    if (!layout.wings[k].half_turned) {
      paste(picture(side), layout.wings[k], cross.whole);
      continue;
    }
    ViewDirection upside_down = kViews[index(side)];  // drawn, not turned: the light comes from the upper left again
    upside_down.roll_deg += 180.0;
    DUBSAR_ASSIGN(const Image image, draw(upside_down));
    paste(image, layout.wings[k], cross.whole);
  }
  paste(ruler, layout.ruler, cross.whole);
  paste(legend, layout.legend, cross.whole);
  paste(text, text_place, cross.whole);
  return cross;
}

}  // namespace dubsar::app
