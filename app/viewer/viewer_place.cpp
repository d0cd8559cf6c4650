#include "app/viewer/viewer_place.h"

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>

#include "app/commands/sides.h"
#include "app/stage/pick_camera.h"
#include "app/words/text.h"
#include "core/base/numbers/inch.h"
#include "core/base/system/utc_day.h"
#include "core/image_io/png_file.h"
#include "core/image_io/tiff_file.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// The first of NAME-001.png, NAME-002.png ... that is not there yet.
fs::path next_free(const std::string& name) {
  for (int number = 1;; ++number) {
    fs::path path = fmt::format("{}-{:03}.png", name, number);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) return path;
  }
}

Result<fs::path> new_picture(const fs::path& path) {
  const std::string suffix = path.extension().string();
  if (suffix != ".png" && suffix != ".tif" && suffix != ".tiff")
    return fail(ErrorKind::kUsage, "picture: cannot write {}, expected a name that ends in .png or .tif",
                path.string());
  std::error_code error;
  if (fs::exists(fs::symlink_status(path, error)))
    return fail(ErrorKind::kUsage, "picture: {} is there already; give another name", path.string());
  return path;
}

Result<void> write(const fs::path& path, const Image& image, double dpi) {
  return path.extension() == ".png" ? write_png(path, image, {.dpi = dpi}) : write_tiff(path, image, dpi);
}

}  // namespace

Result<void> ViewerPlace::switch_display(int step) {
  DUBSAR_TRY(to_.displays.step(step));
  if (step == 0) return {};
  to_.scene.editor->ui().panels = to_.displays.panels_wanted();
  say(tr("say.display", to_.displays.name()));
  return {};
}

Result<void> ViewerPlace::swap_eyes() {
  DUBSAR_TRY(to_.scene.stage->swap_eyes());
  say(tr("say.eyes"));
  return {};
}

void ViewerPlace::recentre_heads() {
  to_.steering.input().recentre();
  to_.scene.stage->recentre();
}

bool ViewerPlace::toggle_source(std::size_t index) {
  if (!to_.sources.toggle(index)) return false;
  to_.answers.sources_changed();
  return true;
}

Result<void> ViewerPlace::open_file(const std::string& path) {
  DUBSAR_TRY(to_.files.open({fs::path(path)}));
  return to_.answers.file_asked();
}

Result<void> ViewerPlace::open_recent(std::size_t number) {
  DUBSAR_TRY(to_.files.open_recent(number));
  return to_.answers.file_asked();
}

Result<void> ViewerPlace::switch_file(int step) {
  DUBSAR_TRY(to_.files.step(step));
  return to_.answers.file_asked();
}

/// What is being read to stand beside is taken away.
bool ViewerPlace::stop_opening() {
  if (to_.files.loader() != nullptr && to_.files.loader()->stop()) return true;
  if (!to_.companion.opening()) return false;
  to_.scene.ask.run("take_away", 0);
  return true;
}

void ViewerPlace::end() {
  if (to_.answers.may_end()) to_.presenter.end();
}

Result<SurfacePin> ViewerPlace::pin_seen() {
  const ToolScene& scene = to_.scene;
  auto picked = scene.picked_at(scene.window.pointer);
  const Shown& shown = scene.stage->shown();
  const double own = shown.compared && !shown.compared->surface ? 1.0 : -1.0;  // which half
  const glm::dvec2 middle = half_offset(shown, scene.stage->window_mm(), {own, -own});
  if (!picked) picked = scene.picked_at({scene.window.aside + middle.x, middle.y});
  if (!picked) return fail(ErrorKind::kUsage, "there is no surface under the pointer");
  return scene.pin(scene.scan_place(*picked));
}

Result<void> ViewerPlace::write_slice(const std::string& path, std::size_t which) {
  DUBSAR_ASSIGN(const fs::path target, new_picture(path));
  DUBSAR_ASSIGN(const Image image, to_.slices.whole(which));
  const glm::dvec3& voxel = to_.scene.mesh->frame.input_voxel.mm;
  DUBSAR_TRY(write(target, image, kMmPerInch / std::min({voxel.x, voxel.y, voxel.z})));
  say(tr("say.picture", target.string(), image.width, image.height));
  return {};
}

Result<void> ViewerPlace::picture(const std::string& path, int factor) {
  const std::string& title = to_.options.around.title;
  const std::string name = title.empty() ? "dubsar" : fs::path(title).stem().string();
  DUBSAR_ASSIGN(const fs::path target, new_picture(path.empty() ? next_free(name) : fs::path(path)));
  Stage& stage = *to_.scene.stage;
  DUBSAR_ASSIGN(const Image image, stage.still(factor));
  // Dots an inch of the object itself, in its middle: printed so, it has its size.
  const double scale = glm::length(glm::dvec3(stage.screen_from_model()[0]));
  const double dpi = image.height / stage.window_mm().y * scale * kMmPerInch;
  DUBSAR_TRY(write(target, image, dpi));
  say(tr("say.picture_dpi", target.string(), image.width, image.height, fmt::format("{:.0f}", dpi)));
  return {};
}

Result<void> ViewerPlace::play_film(std::optional<double> from_s) {
  to_.film.play(from_s, to_.clock.now());
  return {};
}

Result<void> ViewerPlace::find_wedges(const std::string& part) {
  DUBSAR_TRY(to_.wedges.begin(*to_.scene.mesh, to_.scene.document(), part));
  if (to_.scene.window.waits) to_.wedges.wait();  // the same script gives the same pictures
  return {};
}

Result<void> ViewerPlace::publish(const std::string& kind, const std::string& path) {
  const ToolScene& scene = to_.scene;
  if (kind == "atf") {  // small, and written by the window itself
    const fs::path& surface = to_.options.work.surface;
    if (path.empty() && surface.empty()) return fail(ErrorKind::kUsage, "{}", tr("export.no_file"));
    scene.ask.run("write_atf " + (path.empty() ? fs::path(surface).replace_extension(".atf").string() : path), 0);
    return {};
  }
  const Side side = facing_side(scene.window.view.rotation, scene.document().home.rotation);
  DUBSAR_TRY(to_.exporter.begin(
      {kind, to_.options.work.surface.string(), path, std::string(kSideNames[static_cast<std::size_t>(side)])},
      scene.ui().choosing.publishing, scene.document()));
  if (scene.window.waits) to_.exporter.wait();
  return {};
}

std::string ViewerPlace::today() const { return utc_day(std::time(nullptr)); }

}  // namespace dubsar::app
