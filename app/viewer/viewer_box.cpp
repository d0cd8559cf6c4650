// The box of cuts in a session: its handles follow the pointer.

#include "app/tools/cut_box.h"
#include "app/viewer/viewer.h"

namespace dubsar::app {
namespace {

constexpr std::uint64_t kBoxDrags = std::uint64_t{1} << 60;  // told apart from other steps
constexpr double kGrabPx = 1.6 * kHandlePx;

}  // namespace

/// How far the surface reaches is looked for once for each surface and each way it is turned at home.
CutBox Viewer::cut_box() {
  std::optional<ReachedSides>& known = tools_.reached;
  if (!known || known->mesh != given_.mesh || known->home != document().home.rotation) {
    known = ReachedSides{given_.mesh, document().home.rotation, {}};
    for (std::size_t side = 0; side < kBoxSides.size(); side += 2) {  // the next one looks the other way
      const Reach found = known->reach[side] = reach(kBoxSides[side].outward);
      known->reach[side + 1] = {-found.direction, -found.to_mm, -found.from_mm};
    }
  }
  return {known->reach, document()};
}

/// The handle that is held stands out, else the one under the pointer.
std::optional<BoxPicture> Viewer::box_picture() {
  if (!desk().pointing.cut_box || !has_surface() || at_.film_since >= 0) return std::nullopt;
  BoxPicture out = cut_box().picture(Sight::of(*stage_));
  const auto touched = tools_.held_side ? std::optional(tools_.held_side->side()) : touched_handle(out);
  if (touched) out.handles[*touched].touched = true;
  return out;
}

std::optional<std::size_t> Viewer::touched_handle(const BoxPicture& picture) const {
  return handle_at(picture, tools_.pointer, kGrabPx / layout().y);
}

/// A press on a handle takes it: its side is cut as far as the pointer takes it, all of the drag as one step.
bool Viewer::take_handle(const InputEvent& event) {
  const bool left = event.kind == EventKind::kButton && event.button == MouseButton::kLeft;
  if (tools_.held_side && left && !event.down) {
    tools_.held_side.reset();
    return true;
  }
  if (!event.at || (event.kind != EventKind::kButton && event.kind != EventKind::kMotion)) return false;
  const auto picture = box_picture();
  if (!picture) {
    tools_.held_side.reset();
    return false;
  }
  const Sight sight = Sight::of(*stage_);
  if (tools_.held_side) {
    if (event.kind != EventKind::kMotion) return true;
    const CutBox box = cut_box();
    const std::size_t side = tools_.held_side->side();
    run(fmt::format("cut {} {:.3f}", kBoxSides[side].name,
                    box.percent(side, tools_.held_side->at_mm(sight, *event.at))),
        kBoxDrags + at_.presses);
    return true;
  }
  if (!left || !event.down || event.modifiers != 0) return false;
  const auto side = touched_handle(*picture);
  if (!side) return false;
  ++at_.presses;
  tools_.held_side.emplace(cut_box(), *side, sight, *event.at);
  return true;
}

}  // namespace dubsar::app
