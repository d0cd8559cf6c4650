#include "app/tools/box_tool.h"

#include <fmt/format.h>

namespace dubsar::app {
namespace {

constexpr std::uint64_t kBoxDrags = std::uint64_t{1} << 60;  // told apart from other steps
constexpr double kGrabPx = 1.6 * kHandlePx;

}  // namespace

CutBox BoxTool::box() {
  const glm::dquat& home = scene_.document().home.rotation;
  if (!reached_ || reached_->mesh != scene_.mesh || reached_->home != home) {
    reached_ = Reached{scene_.mesh, home, {}};
    for (std::size_t side = 0; side < kBoxSides.size(); side += 2) {  // the next one looks the other way
      const Workplace::Reach found = reached_->reach[side] = scene_.reach(kBoxSides[side].outward, home);
      reached_->reach[side + 1] = {-found.direction, -found.to_mm, -found.from_mm};
    }
  }
  return {reached_->reach, scene_.document()};
}

std::optional<BoxPicture> BoxTool::picture() {
  if (!scene_.ui().pointing.cut_box || !scene_.has_surface() || hidden_) return std::nullopt;
  BoxPicture out = box().picture(PickCamera::of(*scene_.stage));
  const auto touches = held_ ? std::optional(held_->side()) : touched(out);
  if (touches) out.handles[*touches].touched = true;
  return out;
}

std::optional<std::size_t> BoxTool::touched(const BoxPicture& picture) const {
  return handle_at(picture, scene_.window.pointer, kGrabPx / scene_.window.layout.y);
}

bool BoxTool::take(InputEvent& event) {
  const bool left = event.kind == EventKind::kButton && event.button == MouseButton::kLeft;
  if (held_ && left && !event.down) {
    held_.reset();
    return true;
  }
  if (!event.at || (event.kind != EventKind::kButton && event.kind != EventKind::kMotion)) return false;
  const auto seen = picture();
  if (!seen) {
    held_.reset();
    return false;
  }
  const PickCamera camera = PickCamera::of(*scene_.stage);
  if (held_) {
    if (event.kind != EventKind::kMotion) return true;
    const std::size_t side = held_->side();
    scene_.ask.run(
        fmt::format("cut {} {:.3f}", kBoxSides[side].name, box().percent(side, held_->at_mm(camera, *event.at))),
        kBoxDrags + scene_.window.presses);
    return true;
  }
  if (!left || !event.down || event.modifiers != 0) return false;
  const auto side = touched(*seen);
  if (!side) return false;
  ++scene_.window.presses;
  held_.emplace(box(), *side, camera, *event.at);
  return true;
}

}  // namespace dubsar::app
