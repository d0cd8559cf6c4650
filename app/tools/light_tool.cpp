#include "app/tools/light_tool.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/stage/light_over.h"

namespace dubsar::app {
namespace {

constexpr double kBall = 0.42;  // radius of the ball that a drag is on, heights of the window
constexpr std::uint64_t kLightDrags = std::uint64_t{1} << 61;  // told apart from other steps
constexpr double kRoundDeg = 360.0;

}  // namespace

bool LightTool::take(InputEvent& event) {
  if (event.kind == EventKind::kKey && event.key == "l" && (event.modifiers == 0 || (held_ && !event.down))) {
    if (event.down) {
      if (!held_) held_ = Held{event};
      return true;
    }
    if (!held_) return false;
    Held was = *std::move(held_);
    held_.reset();
    if (was.dragged) return true;
    was.key.time = event.time;
    scene_.ask.key(was.key);
    return false;
  }
  if (!held_ || !event.at) return false;
  if (event.kind == EventKind::kButton) {
    if (event.button != MouseButton::kLeft) return false;
    if (event.down) {
      held_->dragged = true;
      ++scene_.window.presses;
    }
  } else if (event.kind != EventKind::kMotion || !held_->dragged) {
    return false;
  }
  const LightPlace light = light_over(event.at->x / kBall, event.at->y / kBall);
  scene_.ask.run(fmt::format("light {:.2f},{:.2f}", std::min(light.azimuth_deg, 359.99), light.elevation_deg),
                 kLightDrags + scene_.window.presses);
  return true;
}

void LightTool::contribute(Shown& shown) {
  ViewState& view = shown.view;
  const std::optional<LightSweep>& sweep = scene_.ui().sweep;
  if (!sweep) {
    sweep_since_ = -1;
  } else {
    if (sweep_since_ < 0) sweep_since_ = now_;
    const double rounds = 1e-9 * static_cast<double>(now_ - sweep_since_) / sweep->period_s;
    view.light_azimuth_deg = std::fmod(view.light_azimuth_deg + kRoundDeg * rounds, kRoundDeg);
    view.light_elevation_deg = sweep->elevation_deg;
  }
  const LightPlace light{view.light_azimuth_deg, view.light_elevation_deg};
  if (held_ || (before_ && *before_ != light)) moved_ = now_;
  before_ = light;
}

}  // namespace dubsar::app
