// What tools and commands of a session do to the surface: places under the pointer, clicks, measures, pictures, films.

#include <chrono>
#include <filesystem>
#include <glm/geometric.hpp>

#include "app/stage/sight.h"
#include "app/viewer/first_document.h"
#include "app/viewer/viewer.h"
#include "core/base/numbers/inch.h"
#include "core/image_io/png_file.h"
#include "core/image_io/tiff_file.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr double kClick = 0.006;  // heights of the window: what moves less is a click

/// The first of NAME-001.png, NAME-002.png ... that is not there yet.
fs::path next_free(const std::string& name) {
  for (int number = 1;; ++number) {
    fs::path path = fmt::format("{}-{:03}.png", name, number);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) return path;
  }
}

}  // namespace

/// What is under this place of the window, with parts where they stand.
std::optional<Picked> Viewer::picked_at(const glm::dvec2& at) const {
  const Shown shown = shown_of(document(), report_.view, given_.options.stage, stage_->box_mm());
  return tools_.picker->pick(shown.parts, Sight::of(*stage_).ray(at), shown.clips);
}

/// An event at a place of the window is told where the surface under it stands and where it is seen from. While the
/// wheel turns at one place, or the same fingers go on, that is looked for once.
void Viewer::tell_depth(InputEvent& event) {
  if (!event.at || given_.options.stage.subject == Subject::kPattern || given_.options.stage.pictures) return;
  const bool wheel = event.kind == EventKind::kWheel, pinch = event.kind == EventKind::kPinch;
  std::optional<InputEvent>& same = tools_.wheeled;
  if (same && same->kind == event.kind && (pinch || (wheel && same->at == event.at))) {
    event.lever = same->lever;
    event.eye = same->eye;
    return;
  }
  same.reset();
  const double height = stage_->window_mm().y;
  if (const auto picked = picked_at(*event.at)) {
    event.lever = glm::dvec4(stage_->screen_from_model() * glm::dvec4(picked->at_mm, 1.0)).z / height;
    event.eye = (stage_->camera_mm() - glm::dvec3(stage_->middle_mm(), 0.0)) / height;
  }
  if (wheel || pinch) same = event;
}

/// Who turns and zooms knows nothing of what stands beside the surface.
InputEvent Viewer::without_aside(InputEvent event) const {
  if (event.at) event.at->x -= aside();
  if (event.eye) event.eye->x -= aside();
  return event;
}

/// With a tool in the hand a press waits: when it is let go where it began it is a click, else the drag turns as ever.
bool Viewer::take_click(const InputEvent& event) {
  std::optional<InputEvent>& press = tools_.press;
  const bool left = event.kind == EventKind::kButton && event.button == MouseButton::kLeft;
  if (left && event.down && event.at && event.modifiers == 0 && tools_.coming.value_or(desk().tool) != "turn") {
    press = event;
    return true;
  }
  if (!press) return false;
  if (left && !event.down && !event.at) {  // a finger that was none
    press.reset();
    return true;
  }
  if (!event.at) return false;
  if (left && !event.down) {
    InputEvent click = *press;  // in its turn with the keys before and after it
    press.reset();
    click.kind = EventKind::kKey;
    click.key = kClickKey;
    expect(click);
    pass_on(click);
    return true;
  }
  if (event.kind != EventKind::kMotion) return false;
  if (glm::distance(*event.at, *press->at) <= kClick) return true;
  InputEvent begun = *press;
  press.reset();
  tell_depth(begun);
  pass_on(without_aside(begun));
  return false;
}

/// Where a place that is seen lies in the scan: parts stand apart.
glm::dvec3 Viewer::scan_place(const Picked& picked) const {
  const PartitionId id = given_.mesh->partition_of(picked.triangle);
  const Shown shown = shown_of(document(), report_.view, given_.options.stage, stage_->box_mm());
  return picked.at_mm - shown.parts[std::min<std::size_t>(id, shown.parts.size() - 1)].offset_mm;
}

void Viewer::click(const glm::dvec2& at) {
  const auto picked = picked_at(at);
  if (!picked) return say("There is no surface here.");
  const glm::dvec3 there = scan_place(*picked);
  ++at_.presses;
  run(fmt::format("point {:.6f},{:.6f},{:.6f}", there.x, there.y, there.z));
}

std::string Viewer::today() const {
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()));
}

Result<SurfacePin> Viewer::pin(const glm::dvec3& at_mm) {
  DUBSAR_ASSIGN(SurfacePin out, pin_on(*given_.mesh, document().parts, at_mm));
  const glm::dmat3 home =
      glm::mat3_cast(document().home.rotation) * first_turn(stage_->box_mm(), given_.options.stage.direction);
  out.side = side_of(out.normal, home);
  return out;
}

Result<MeasureFigures> Viewer::figures(const Measure& measure) { return figures_of(*given_.mesh, measure); }

Workplace::Reach Viewer::reach_of(const glm::dvec3& direction, const glm::dquat& rotation) const {
  const glm::dmat3 turn = glm::mat3_cast(rotation) * first_turn(stage_->box_mm(), given_.options.stage.direction);
  return reach_along(*given_.mesh, glm::normalize(glm::transpose(turn) * direction));
}
Workplace::Reach Viewer::reach(const glm::dvec3& home_direction) {
  return reach_of(home_direction, document().home.rotation);
}
Workplace::Reach Viewer::reach_to_viewer() { return reach_of({0, 0, 1}, report_.view.rotation); }

Result<fs::path> Viewer::new_picture(const fs::path& path) {
  const std::string suffix = path.extension().string();
  if (suffix != ".png" && suffix != ".tif" && suffix != ".tiff")
    return fail(ErrorKind::kUsage, "picture: cannot write {}, expected a name that ends in .png or .tif",
                path.string());
  std::error_code error;
  if (fs::exists(fs::symlink_status(path, error)))
    return fail(ErrorKind::kUsage, "picture: {} is there already; give another name", path.string());
  return path;
}

Result<void> Viewer::picture(const std::string& path, int factor) {
  const std::string name =
      given_.options.around.title.empty() ? "dubsar" : fs::path(given_.options.around.title).stem().string();
  DUBSAR_ASSIGN(const fs::path target, new_picture(path.empty() ? next_free(name) : fs::path(path)));
  DUBSAR_ASSIGN(const Image image, stage_->still(factor));
  // Dots an inch of the object itself, in its middle: printed so, it has its size.
  const double scale = glm::length(glm::dvec3(stage_->screen_from_model()[0]));
  const double dpi = image.height / stage_->window_mm().y * scale * kMmPerInch;
  if (target.extension() == ".png") {
    DUBSAR_TRY(write_png(target, image, {.dpi = dpi}));
  } else {
    DUBSAR_TRY(write_tiff(target, image, dpi));
  }
  say(fmt::format("written: {}, {} x {} pixels, {:.0f} dots an inch at life size", target.string(), image.width,
                  image.height, dpi));
  return {};
}

Result<void> Viewer::play_film(std::optional<double> from_s) {
  at_.film_since = at_.film_since >= 0 && !from_s ? -1 : given_.clock.now();
  at_.film_from_s = from_s.value_or(0.0);
  return {};
}

/// The document as the film shows it now; its end is the film's end.
Document Viewer::shown_document(TimestampNs now) {
  Document out = document();
  const double since = at_.film_from_s + 1e-9 * static_cast<double>(now - at_.film_since);
  if (out.keyframes.empty() || since > film_length_s(out.keyframes)) {
    at_.film_since = -1;
    return out;
  }
  show_keyframe(out, moment_at(document().keyframes, out.keyframes.front().time_s + since));
  return out;
}

}  // namespace dubsar::app
