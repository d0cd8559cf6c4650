// Commands that turn, move and zoom, and those that go back.

#include <algorithm>
#include <cmath>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "app/commands/sides.h"
#include "core/base/numbers/angle.h"
#include "input/navigation/square_turn.h"

namespace dubsar::app {
namespace {

/// "turn_left", "turn_left 1": about an axis of the screen.
Command turn(std::string name, const glm::dvec3& axis, std::vector<DefaultKey> keys) {
  Command out{std::move(name), "group.view", std::move(keys), "arg.degrees"};
  out.optional = out.repeats = out.steers = true;
  out.run = [axis, what = out.name](Editor& editor, const std::string& argument) -> Result<void> {
    double degrees = editor.steps().turn_deg;
    if (!argument.empty()) {
      DUBSAR_ASSIGN(degrees, number_argument(what, argument, 0.0, 360.0));
    }
    Document next = editor.document();
    next.now.rotation = glm::normalize(turn_of(degrees * kRadPerDeg * axis) * next.now.rotation);
    editor.change(std::move(next), what);
    return {};
  };
  return out;
}

Command zoom(std::string name, bool in, std::vector<DefaultKey> keys) {
  Command out{std::move(name), "group.view", std::move(keys)};
  out.repeats = out.steers = true;
  out.run = [in, why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    const double factor = in ? editor.steps().zoom : 1.0 / editor.steps().zoom;
    next.now.zoom *= factor;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// Glides to the camera that `where` makes of the document.
Command go(std::string name, Text group, std::vector<DefaultKey> keys,
           std::function<CameraPose(const Document&, const std::string&)> where) {
  Command out{std::move(name), group, std::move(keys)};
  out.steers = true;
  out.run = [where = std::move(where), why = out.name](Editor& editor, const std::string& argument) -> Result<void> {
    Document next = editor.document();
    next.now = where(next, argument);
    editor.change(std::move(next), why, Transition::kGlide);
    return {};
  };
  return out;
}

Command side() {
  Command out = go("side", "group.sides",
                   {{"1", "obverse"}, {"2", "bottom"}, {"3", "reverse"}, {"4", "top"}, {"5", "left"}, {"6", "right"}},
                   [](const Document& document, const std::string& name) {
                     const auto* const at = std::find(kSideNames.begin(), kSideNames.end(), name);
                     CameraPose camera = document.now;
                     camera.rotation = turn_to(static_cast<Side>(at - kSideNames.begin()), document.home.rotation);
                     return camera;
                   });
  out.argument = "arg.side";
  out.values.assign(kSideNames.begin(), kSideNames.end());
  out.closed = true;
  return out;
}

Command obverse_here() {
  Command out{"obverse_here", "group.sides", {{"ctrl+home"}}};
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    next.home.rotation = nearest_square_turn(next.now.rotation);
    next.now.rotation = next.home.rotation;
    editor.change(std::move(next), why, Transition::kGlide);
    return {};
  };
  return out;
}

/// For where the writing misled the program. The home view turns with it, so that all sides count anew.
Command upright() {
  Command out{"upright", "group.sides", {{"shift+home", "half"}, {"ctrl+shift+home", "over"}}};
  out.argument = "arg.way";
  out.values = {"half", "left", "right", "over"};
  out.closed = true;
  out.run = [why = out.name](Editor& editor, const std::string& way) -> Result<void> {
    const double s = std::sqrt(0.5);  // of quarters about the viewer's axis, counterclockwise; over: about the lines
    const glm::dquat turn = way == "half"    ? glm::dquat(0, 0, 0, 1)
                            : way == "left"  ? glm::dquat(s, 0, 0, s)
                            : way == "right" ? glm::dquat(s, 0, 0, -s)
                                             : glm::dquat(0, 1, 0, 0);
    Document next = editor.document();
    next.home.rotation = glm::normalize(turn * next.home.rotation);
    next.now.rotation = next.home.rotation;
    editor.change(std::move(next), why, Transition::kGlide);
    return {};
  };
  return out;
}

Command history(const std::string& name, bool back, std::vector<DefaultKey> keys) {
  Command out{name, "group.back", std::move(keys)};
  out.repeats = out.steers = true;
  out.enabled = [back](const Editor& editor) {
    return (back ? editor.history().undo_depth() : editor.history().redo_depth()) > 0;
  };
  out.run = [back](Editor& editor, const std::string&) -> Result<void> {
    static_cast<void>(back ? editor.undo() : editor.redo());
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> view_commands() {
  std::vector<Command> out;
  out.push_back(side());
  out.push_back(obverse_here());
  out.push_back(upright());
  out.push_back(
      go("next_side", "group.sides", {{"space"}, {"puck1"}}, [](const Document& document, const std::string&) {
        CameraPose camera = document.now;
        camera.rotation = glm::normalize(turn_to(Side::kLeft) * nearest_square_turn(camera.rotation));
        return camera;
      }));
  out.push_back(go("reset", "group.view", {{"home"}, {"puck2"}},
                   [](const Document& document, const std::string&) { return document.home; }));
  out.back().run = [why = out.back().name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    set_view(next, home_of(next));
    editor.change(std::move(next), why, Transition::kGlide);
    return {};
  };
  out.push_back(turn("turn_left", {0, -1, 0}, {{"left"}, {"shift+left", "1"}}));
  out.push_back(turn("turn_right", {0, 1, 0}, {{"right"}, {"shift+right", "1"}}));
  out.push_back(turn("turn_up", {-1, 0, 0}, {{"up"}, {"shift+up", "1"}}));
  out.push_back(turn("turn_down", {1, 0, 0}, {{"down"}, {"shift+down", "1"}}));
  out.push_back(turn("roll_left", {0, 0, 1}, {{"page_up"}, {"shift+page_up", "1"}}));
  out.push_back(turn("roll_right", {0, 0, -1}, {{"page_down"}, {"shift+page_down", "1"}}));
  out.push_back(zoom("zoom_in", true, {{"+"}, {"="}}));
  out.push_back(zoom("zoom_out", false, {{"-"}}));
  out.push_back(history("undo", true, {{"backspace"}, {"ctrl+z"}}));
  out.push_back(history("redo", false, {{"ctrl+shift+z"}, {"ctrl+y"}}));
  return out;
}

}  // namespace dubsar::app
