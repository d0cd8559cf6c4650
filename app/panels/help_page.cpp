#include "app/panels/help_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/words/text.h"

namespace dubsar::app {
namespace {

const std::string& drag_words(Action action) {
  switch (action) {
    case Action::kRotate:
      return tr("drag.rotate");
    case Action::kRotateFine:
      return tr("drag.rotate_fine");
    case Action::kPan:
      return tr("drag.pan");
    case Action::kZoom:
      return tr("drag.zoom");
    case Action::kZoomAndRoll:
      return tr("drag.zoom_and_roll");
    case Action::kLight:
      return tr("drag.light");
    case Action::kNextSide:
      return tr("drag.next_side");
    case Action::kSelect:
      return tr("drag.select");
    case Action::kReset:
      return tr("drag.reset");
    default:
      return tr(Text());
  }
}

void add(HelpSection& section, std::string what, std::string does) {
  if (!does.empty()) section.rows.push_back({std::move(what), std::move(does)});
}

/// "Umschalt+links" in German of the mapping's "shift+left".
std::string chord_words(const std::string& chord) {
  std::string out;
  for (std::size_t at = 0; at <= chord.size();) {
    const std::size_t end = std::min(chord.find('+', at), chord.size());
    out += (at == 0 ? "" : "+") + tr_name("chord", chord.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

HelpSection mouse_section(const MouseMapping& mouse) {
  HelpSection out{tr("help.mouse"), {}};
  for (const auto& [chord, action] : mouse.chords)
    add(out, chord.ends_with("wheel") ? chord_words(chord) : tr("help.drag", chord_words(chord)), drag_words(action));
  const auto turns = mouse.chords.find("left");
  if (turns != mouse.chords.end() && turns->second == Action::kRotate)
    add(out, tr("help.left_twice"), tr("help.to_middle"));
  const auto chords = [](const HelpRow& row) { return std::count(row.what.begin(), row.what.end(), '+'); };
  std::stable_sort(out.rows.begin(), out.rows.end(),
                   [&](const HelpRow& a, const HelpRow& b) { return chords(a) < chords(b); });
  return out;
}

/// A finger is the left button alone.
HelpSection touch_section(const MouseMapping& mouse) {
  HelpSection out{tr("help.touch"), {}};
  add(out, tr("help.finger"), drag_words(chord_action(mouse, kNoModifier, "left")));
  add(out, tr("help.two_fingers"), tr("help.two_fingers_do"));
  add(out, tr("help.tap"), tr("help.click"));
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
  std::string words = tr(command.words);
  if (found.empty() && told.size() > 2) {
    found = is_row(told) ? std::vector<std::string>{tr("help.range", key_words(told.front()), key_words(told.back()))}
                         : said(told);
    std::string values;
    for (const std::string& value : command.values)
      values += (values.empty() ? "" : ", ") + argument_words(command, value);
    if (command.closed && values.size() <= kLongestList) words += ": " + values;
  } else {
    found.insert(found.end(), told.begin(), told.end());
    found = said(found);
  }
  if (!found.empty()) add(section, fmt::format("{}", fmt::join(found, "  ")), std::move(words));
}

HelpSection hand_section(const HandMapping& hands) {
  HelpSection out{tr("help.hands"), {}};
  add(out, tr("help.grab"), drag_words(hands.grab));
  add(out, tr("help.pull"), drag_words(hands.pull));
  add(out, tr("help.both"), drag_words(hands.two_hands));
  add(out, tr("help.pinch"), drag_words(hands.pinch));
  add(out, tr("help.swipe"), drag_words(hands.swipe));
  add(out, tr("help.rest"), drag_words(hands.dwell));
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
    auto at = std::find_if(out.begin(), out.end(), [&](const HelpSection& s) { return s.title == tr(command.group); });
    if (at == out.end()) at = out.insert(out.end(), HelpSection{tr(command.group), {}});
    add_command(*at, command, keys, there);
  }
  std::rotate(out.begin(), std::min(out.begin() + 1, out.end()), out.end());  // the window's own come last
  return out;
}

}  // namespace

std::vector<HelpSection> help_page(const Mapping& mapping, const KeyTable& keys, const HelpDevices& there) {
  const auto listens = [&](Control control) {
    return std::find(mapping.priority.begin(), mapping.priority.end(), control) != mapping.priority.end();
  };
  std::vector<HelpSection> out;
  if (listens(Control::kMouse)) out.push_back(mouse_section(mapping.mouse));
  if (there.more && listens(Control::kHands)) out.push_back(hand_section(mapping.hands));
  if (there.more && listens(Control::kSpaceMouse))
    out.push_back(
        {tr("help.puck"), {{tr("help.push"), tr("help.push_does")}, {tr("help.twist"), tr("help.twist_does")}}});
  if (there.touch && listens(Control::kMouse)) out.push_back(touch_section(mapping.mouse));
  for (HelpSection& section : command_sections(keys, listens(Control::kKeyboard), there))
    out.push_back(std::move(section));
  std::erase_if(out, [](const HelpSection& s) { return s.rows.empty(); });
  return out;
}

}  // namespace dubsar::app
