// The light of a session while it is dragged or goes round, and what stands under the pointer.

#include <cmath>

#include "app/stage/light_over.h"
#include "app/stage/marks.h"
#include "app/viewer/first_document.h"
#include "app/viewer/viewer.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {

constexpr double kBall = 0.42;  // radius of the ball that a drag is on, heights of the window
constexpr std::uint64_t kLightDrags = std::uint64_t{1} << 61;  // told apart from other steps
constexpr double kRoundDeg = 360.0;

}  // namespace

/// While L is held a drag puts the light over the place of the pointer, as if the window were a ball; when nothing was
/// dragged the key does what it does elsewhere.
bool Viewer::take_light(const InputEvent& event) {
  std::optional<HeldLight>& held = tools_.held_light;
  if (event.kind == EventKind::kKey && event.key == "l" && (event.modifiers == 0 || (held && !event.down))) {
    if (event.down) {
      if (!held) held = HeldLight{event};
      return true;
    }
    if (!held) return false;
    const bool dragged = held->dragged;
    InputEvent down = held->key;
    held.reset();
    if (dragged) return true;
    down.time = event.time;
    pass_on(down);
    return false;
  }
  if (!held || !event.at) return false;
  if (event.kind == EventKind::kButton) {
    if (event.button != MouseButton::kLeft) return false;
    if (event.down) {
      held->dragged = true;
      ++at_.presses;
    }
    tools_.press.reset();
  } else if (event.kind != EventKind::kMotion || !held->dragged) {
    return false;
  }
  const LightPlace light = light_over(event.at->x / kBall, event.at->y / kBall);
  run(fmt::format("light {:.2f},{:.2f}", std::min(light.azimuth_deg, 359.99), light.elevation_deg),
      kLightDrags + at_.presses);
  return true;
}

/// The light of the next picture: that of the view, or one that goes round.
void Viewer::move_light(TimestampNs now, ViewState& view) {
  const std::optional<LightSweep>& sweep = desk().sweep;
  if (!sweep) {
    at_.sweep_since = -1;
  } else {
    if (at_.sweep_since < 0) at_.sweep_since = now;
    const double rounds = 1e-9 * static_cast<double>(now - at_.sweep_since) / sweep->period_s;
    view.light_azimuth_deg = std::fmod(view.light_azimuth_deg + kRoundDeg * rounds, kRoundDeg);
    view.light_elevation_deg = sweep->elevation_deg;
  }
  const ViewState& before = report_.view;
  if (tools_.held_light || (at_.light_known && (before.light_azimuth_deg != view.light_azimuth_deg ||
                                                before.light_elevation_deg != view.light_elevation_deg)))
    at_.light_moved = now;
  at_.light_known = true;
}

/// The glass and the ring follow the pointer over the surface.
void Viewer::point() {
  Decor decor;
  const Pointing& seen = desk().pointing;
  if ((seen.magnify > 0 || seen.cursor) && seen.at) {
    const auto place = stage_->place_at(*seen.at);
    if (!place) log_warning("{}", place.error().message);
    if (place && *place) {
      if (seen.magnify > 0) decor.lens = Lens{**place, seen.magnify};
      if (seen.cursor) decor.cursor_mm = **place;
    }
  }
  stage_->set_decor(decor);
}

/// The state that was put beside the present one, whose view is `view`.
std::shared_ptr<const Shown> Viewer::beside(const ViewState& view) const {
  const Document& kept = *desk().beside;
  auto out = std::make_shared<Shown>(
      shown_of(kept, desk().linked ? view : view_of(kept), given_.options.stage, stage_->box_mm()));
  out->marks = marks_of(kept, desk(), out->parts, *tools_.font, letters_scale());
  return out;
}

}  // namespace dubsar::app
