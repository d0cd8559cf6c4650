#include "app/panels/help_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace dubsar::app {
namespace {

std::string drag_words(Action action) {
  switch (action) {
    case Action::kRotate:
      return "turn";
    case Action::kRotateFine:
      return "turn slowly";
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

void add(HelpSection& section, std::string what, std::string does) {
  if (!does.empty()) section.rows.push_back({std::move(what), std::move(does)});
}

HelpSection mouse_section(const MouseMapping& mouse) {
  HelpSection out{"Mouse", {}};
  for (const auto& [chord, action] : mouse.chords)
    add(out, chord.ends_with("wheel") ? chord : chord + " drag", drag_words(action));
  const auto turns = mouse.chords.find("left");
  if (turns != mouse.chords.end() && turns->second == Action::kRotate)
    add(out, "left twice", "what is pointed at goes to the middle");
  const auto chords = [](const HelpRow& row) { return std::count(row.what.begin(), row.what.end(), '+'); };
  std::stable_sort(out.rows.begin(), out.rows.end(),
                   [&](const HelpRow& a, const HelpRow& b) { return chords(a) < chords(b); });
  return out;
}

/// A finger is the left button alone.
HelpSection touch_section(const MouseMapping& mouse) {
  HelpSection out{"Touch", {}};
  add(out, "a finger", drag_words(chord_action(mouse, kNoModifier, "left")));
  add(out, "two fingers", "zoom, move and roll");
  add(out, "a tap", "click");
  return out;
}

constexpr std::size_t kLongestList = 72;  // letters; what is longer is for the palette

/// "1", "2", "3" ... or "alt+1", "alt+2" ...
bool is_row(const std::vector<std::string>& keys) {
  if (keys.size() < 3) return false;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::string expected = keys.front();
    expected.back() = static_cast<char>(expected.back() + i);
    if (keys[i] != expected || keys[i].back() < '1' || keys[i].back() > '9') return false;
  }
  return true;
}

std::vector<std::string> said(const std::vector<std::string>& keys) {
  std::vector<std::string> out;
  for (const std::string& key : keys) out.push_back(key_words(key));
  return out;
}

/// One line of a command that has keys: "Left  Shift+Left", or "1 to 6" where each says something else.
void add_command(HelpSection& section, const Command& command, const KeyTable& keys, const HelpDevices& there) {
  std::vector<std::string> found = keys.keys_for(command.name);
  if (!there.more) std::erase_if(found, [](const std::string& key) { return key.starts_with("puck"); });
  std::vector<std::string> told;
  for (const DefaultKey& key : command.keys)
    if (!key.argument.empty())
      for (std::string& each : keys.keys_for(command.name + " " + key.argument)) told.push_back(std::move(each));
  std::string words = command.words;
  if (found.empty() && told.size() > 2) {
    found =
        is_row(told) ? std::vector<std::string>{key_words(told.front()) + " to " + key_words(told.back())} : said(told);
    const std::string values = fmt::format("{}", fmt::join(command.values, ", "));
    if (command.closed && values.size() <= kLongestList) words += ": " + values;
  } else {
    found.insert(found.end(), told.begin(), told.end());
    found = said(found);
  }
  if (!found.empty()) add(section, fmt::format("{}", fmt::join(found, "  ")), std::move(words));
}

HelpSection hand_section(const HandMapping& hands) {
  HelpSection out{"Hands", {}};
  add(out, "grab and move", drag_words(hands.grab));
  add(out, "grab and pull", drag_words(hands.pull));
  add(out, "grab with both", drag_words(hands.two_hands));
  add(out, "pinch and move", drag_words(hands.pinch));
  add(out, "swipe", drag_words(hands.swipe));
  add(out, "rest", drag_words(hands.dwell));
  return out;
}

/// Commands by their headings, in the order of the table.
std::vector<HelpSection> command_sections(const KeyTable& keys, bool keyboard_steers, const HelpDevices& there) {
  const auto idle = [&](const Command& command) {
    return (!there.two_eyes && command.name == "swap_eyes") || (!there.more && command.name == "recentre");
  };
  std::vector<HelpSection> out;
  for (const Command& command : keys.commands().all()) {
    if ((command.steers && !keyboard_steers) || idle(command)) continue;
    auto at = std::find_if(out.begin(), out.end(), [&](const HelpSection& s) { return s.title == command.group; });
    if (at == out.end()) at = out.insert(out.end(), HelpSection{command.group, {}});
    add_command(*at, command, keys, there);
  }
  std::rotate(out.begin(), std::min(out.begin() + 1, out.end()), out.end());  // the window's own come last
  return out;
}

}  // namespace

std::vector<HelpSection> help_page(const Mapping& mapping, const KeyTable& keys, const HelpDevices& there) {
  std::vector<HelpSection> out{mouse_section(mapping.mouse),
                               hand_section(mapping.hands),
                               {"Puck", {{"push", "move and zoom"}, {"twist", "turn"}}},
                               touch_section(mapping.mouse)};
  const auto listens = [&](Control control) {
    return std::find(mapping.priority.begin(), mapping.priority.end(), control) != mapping.priority.end();
  };
  for (HelpSection& section : command_sections(keys, listens(Control::kKeyboard), there))
    out.push_back(std::move(section));
  std::erase_if(out, [&](const HelpSection& s) {
    return s.rows.empty() || (s.title == "Mouse" && !listens(Control::kMouse)) ||
           (s.title == "Touch" && !(there.touch && listens(Control::kMouse))) ||
           (s.title == "Hands" && !(there.more && listens(Control::kHands))) ||
           (s.title == "Puck" && !(there.more && listens(Control::kPuck)));
  });
  return out;
}

}  // namespace dubsar::app
