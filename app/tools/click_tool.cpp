#include "app/tools/click_tool.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <utility>

#include "app/words/text.h"

namespace dubsar::app {
namespace {

constexpr double kClick = 0.006;  // heights of the window: what moves less is a click

}  // namespace

bool ClickTool::take(InputEvent& event) {
  const bool left = event.kind == EventKind::kButton && event.button == MouseButton::kLeft;
  if (left && event.down && event.at && event.modifiers == 0 && scene_.ui().tool != "turn") {
    press_ = event;
    return true;
  }
  if (!press_) return false;
  if (left && !event.down && !event.at) {  // a finger that was none
    press_.reset();
    return true;
  }
  if (!event.at) return false;
  if (left && !event.down) {
    click(*std::exchange(press_, std::nullopt)->at);
    return true;
  }
  if (event.kind != EventKind::kMotion) return false;
  if (glm::distance(*event.at, *press_->at) <= kClick) return true;
  scene_.ask.steers(*std::exchange(press_, std::nullopt));
  return false;
}

void ClickTool::click(const glm::dvec2& at) {
  const auto picked = scene_.picked_at(at);
  if (!picked) return scene_.ask.say(tr("say.no_surface_here"));
  const glm::dvec3 there = scene_.scan_place(*picked);
  ++scene_.window.presses;
  scene_.ask.run(fmt::format("point {:.6f},{:.6f},{:.6f}", there.x, there.y, there.z), 0);
}

}  // namespace dubsar::app
