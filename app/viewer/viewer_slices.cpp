// Slices of the scan in a session: beside the surface, and on it.

#include <glm/geometric.hpp>

#include "app/panels/slice_panel.h"
#include "app/viewer/first_document.h"
#include "app/viewer/viewer.h"
#include "core/base/numbers/inch.h"
#include "core/image_io/png_file.h"
#include "core/image_io/tiff_file.h"

namespace dubsar::app {
namespace {

constexpr float kToolsWidth = 82.0f, kTabWidth = 90.0f;  // what stands at the sides besides

}  // namespace

/// How far the surface stands to the right of the window's middle while slices are beside it, in heights of the window.
double Viewer::aside() const {
  if (!shows_slices()) return 0.0;
  const glm::dvec2 layout = this->layout();
  const auto taken = static_cast<double>(slices_width(static_cast<float>(layout.x)) + kTabWidth - kToolsWidth);
  return -0.5 * taken / layout.y;
}

void Viewer::lay_slices(Shown& shown) {
  const SinkTraits traits = stage_->traits();
  const glm::dvec2 layout = this->layout();
  const ScanView& view = document().scan;
  const glm::dvec2 px = glm::dvec2(traits.view.width, traits.view.height) / layout;
  const auto rects = slice_rects(static_cast<float>(layout.x), static_cast<float>(layout.y), view.large);
  tools_.slices->update(view, rects, px);
  if (given_.options.time.fps > 0) {  // the same script gives the same pictures
    tools_.slices->wait();
    tools_.slices->update(view, rects, px);
  }
  const double left =
      layout.x - static_cast<double>(slices_width(static_cast<float>(layout.x)) + kTabWidth + kToolsWidth);
  shown.view.pan.x += aside();
  shown.fit *= std::min(1.0, left / std::min(layout.x, layout.y));
  for (LinesItem& lines : tools_.slices->lines(view, shown.parts)) shown.marks.lines.push_back(std::move(lines));
}

Result<SurfacePin> Viewer::pin_seen() {
  auto picked = picked_at(tools_.pointer);
  if (!picked) picked = picked_at({aside(), 0.0});
  if (!picked) return fail(ErrorKind::kUsage, "there is no surface under the pointer");
  return pin(scan_place(*picked));
}

glm::dmat3 Viewer::seen_axes() {
  return glm::transpose(glm::mat3_cast(report_.view.rotation) *
                        first_turn(stage_->box_mm(), given_.options.stage.direction));
}

Result<void> Viewer::write_slice(const std::string& path, std::size_t which) {
  DUBSAR_ASSIGN(const std::filesystem::path target, new_picture(path));
  DUBSAR_ASSIGN(const Image image, tools_.slices->whole(document().scan, which));
  const glm::dvec3& voxel = given_.mesh->frame.input_voxel.mm;
  const double dpi = kMmPerInch / std::min({voxel.x, voxel.y, voxel.z});
  if (target.extension() == ".png") {
    DUBSAR_TRY(write_png(target, image, {.dpi = dpi}));
  } else {
    DUBSAR_TRY(write_tiff(target, image, dpi));
  }
  say(fmt::format("written: {}, {} x {} pixels", target.string(), image.width, image.height));
  return {};
}

}  // namespace dubsar::app
