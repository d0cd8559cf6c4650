#include "app/panels/help_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/viewer/session_keys.h"

namespace dubsar::app {
namespace {

std::string drag_words(Action action) {
  switch (action) {
    case Action::kRotate:
      return "turn";
    case Action::kPan:
      return "move";
    case Action::kZoom:
      return "zoom";
    case Action::kZoomAndRoll:
      return "zoom and roll";
    case Action::kLight:
      return "move the light";
    case Action::kNextSide:
      return "quarter turn to the next side";
    case Action::kSelect:
      return "select";
    case Action::kReset:
      return "back to the first view";
    default:
      return {};
  }
}

/// Actions that belong into one line.
struct Family {
  std::vector<Action> actions;
  std::string words;
};

void add(HelpSection& section, std::string what, std::string does) {
  if (!does.empty()) section.rows.push_back({std::move(what), std::move(does)});
}

HelpSection mouse_section(const MouseMapping& mouse) {
  HelpSection out{"Mouse", {}};
  for (const auto& [chord, action] : mouse.chords)
    add(out, chord.ends_with("wheel") ? chord : chord + " drag", drag_words(action));
  const auto chords = [](const HelpRow& row) { return std::count(row.what.begin(), row.what.end(), '+'); };
  std::stable_sort(out.rows.begin(), out.rows.end(),
                   [&](const HelpRow& a, const HelpRow& b) { return chords(a) < chords(b); });
  return out;
}

HelpSection key_section(const Mapping& mapping) {
  const std::string step = fmt::format("{:g} degrees", mapping.key_step_deg);
  const std::vector<Family> families{
      {{Action::kTurnLeft, Action::kTurnRight, Action::kTurnUp, Action::kTurnDown}, "turn by " + step},
      {{Action::kRollLeft, Action::kRollRight}, "roll by " + step},
      {{Action::kZoomIn, Action::kZoomOut}, "zoom in, out"},
      {{Action::kNextSide}, "quarter turn to the next side"},
      {{Action::kReset}, "back to the first view"},
      {{Action::kUndo}, "undo"},
  };
  HelpSection out{"Keys", {}};
  for (const Family& family : families) {
    std::string keys;
    for (const Action action : family.actions)
      for (const auto& [key, mapped] : mapping.keys)
        if (mapped == action) keys.append(keys.empty() ? "" : " ").append(key);
    if (!keys.empty()) add(out, keys, family.words);
  }
  return out;
}

HelpSection hand_section(const HandMapping& hands) {
  HelpSection out{"Hands", {}};
  add(out, "grab and move", drag_words(hands.grab));
  add(out, "grab with both", drag_words(hands.two_hands));
  add(out, "pinch and move", drag_words(hands.pinch));
  add(out, "swipe", drag_words(hands.swipe));
  add(out, "rest", drag_words(hands.dwell));
  return out;
}

HelpSection session_section() {
  HelpSection out{"This window", {}};
  for (const SessionKey& key : kSessionKeys) {
    if (!out.rows.empty() && out.rows.back().does == key.words) {
      out.rows.back().what.append(" ").append(key.key);
    } else {
      add(out, std::string(key.key), std::string(key.words));
    }
  }
  add(out, "1 to 9", "source on or off, while this help is shown");
  return out;
}

}  // namespace

std::vector<HelpSection> help_page(const Mapping& mapping) {
  std::vector<HelpSection> out{mouse_section(mapping.mouse),
                               key_section(mapping),
                               hand_section(mapping.hands),
                               {"Puck", {{"push", "move and zoom"}, {"twist", "turn"}}},
                               session_section()};
  const auto listens = [&](Control control) {
    return std::find(mapping.priority.begin(), mapping.priority.end(), control) != mapping.priority.end();
  };
  std::erase_if(out, [&](const HelpSection& s) {
    return s.rows.empty() || (s.title == "Mouse" && !listens(Control::kMouse)) ||
           (s.title == "Keys" && !listens(Control::kKeyboard)) || (s.title == "Hands" && !listens(Control::kHands)) ||
           (s.title == "Puck" && !listens(Control::kPuck));
  });
  return out;
}

}  // namespace dubsar::app
