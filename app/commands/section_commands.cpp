// Commands that cut parts of what is seen away, and let the far side fade.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "app/commands/box_sides.h"
#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"

namespace dubsar::app {
namespace {

constexpr std::size_t kMostCuts = 6;  // of eight planes that the renderer has
constexpr double kStep = 0.02;        // of the object's depth

bool across(const Cut& cut, const glm::dvec3& direction) { return glm::distance(cut.normal, direction) < 1e-9; }

/// The cut across a direction, once: a second one of the same direction takes its place.
void set_cut(Document& document, const glm::dvec3& normal, double distance_mm) {
  const auto same =
      std::find_if(document.clips.begin(), document.clips.end(), [&](const Cut& cut) { return across(cut, normal); });
  if (same != document.clips.end()) {
    *same = {normal, distance_mm, true};
  } else {
    if (document.clips.size() == kMostCuts) document.clips.erase(document.clips.begin());
    document.clips.push_back({normal, distance_mm, true});
  }
}

/// A share of the object away from a side; nothing of it takes the cut away.
void cut_side(Document& document, const Workplace::Reach& reach, double percent) {
  if (percent > 0)
    set_cut(document, reach.direction, reach.to_mm - 0.01 * percent * (reach.to_mm - reach.from_mm));
  else
    std::erase_if(document.clips, [&](const Cut& cut) { return across(cut, reach.direction); });
}

Command cut() {
  Command out{"cut", "group.cuts", {}, "arg.side_percent"};
  out.values = {"front 20", "left 50", "front 0"};
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const auto words = first_word(text);
    const std::string &side = words.first, &share = words.second;
    const auto* const at =
        std::find_if(kBoxSides.begin(), kBoxSides.end(), [&](const BoxSide& row) { return row.name == side; });
    if (at == kBoxSides.end())
      return fail(ErrorKind::kUsage, "cut: \"{}\" found, expected front, back, left, right, top or bottom", side);
    DUBSAR_ASSIGN(const double percent, number_argument("cut", share, 0.0, 100.0));
    Document next = editor.document();
    cut_side(next, editor.place().reach(at->outward), percent);
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// One number for all sides, or one for each: left, right, bottom, top, back, front.
Command cut_box() {
  Command out{"cut_box", "group.cuts", {}};
  out.argument = "arg.cut_box";
  out.values = {"10", "0,0,0,0,0,40", "0"};
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    std::array<double, 6> percent{};
    const bool all = text.find(',') == std::string::npos;
    std::string rest = text;
    for (double& each : percent) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      DUBSAR_ASSIGN(each, number_argument("cut_box", all ? text : rest.substr(0, comma), 0.0, all ? 49.0 : 100.0));
      rest.erase(0, comma + 1);
    }
    if (!rest.empty() && !all)
      return fail(ErrorKind::kUsage, "cut_box: \"{}\" found, expected one number or six", text);
    Document next = editor.document();
    next.clips.clear();
    for (std::size_t side = 0; side < percent.size(); ++side)
      if (percent[side] > 0) cut_side(next, editor.place().reach(kBoxSides[side].outward), percent[side]);
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// Dragging one is "cut SIDE PERCENT", again and again, as one step.
Command cut_handles() {
  Command out{"cut_handles", "group.cuts", {{"alt+h"}}};
  out.run = [](Editor& editor, const std::string&) -> Result<void> {
    bool& box = editor.ui().pointing.cut_box;
    box = !box;
    return {};
  };
  return out;
}

/// Whether what is cut through is filled.
Command section() {
  Command out{"section", "group.cuts", {{"shift+x"}}};
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    next.style.section = !next.style.section;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command cut_here() {
  Command out{"cut_here", "group.cuts", {{"h"}}};
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    const Workplace::Reach reach = editor.place().reach_to_viewer();
    Document next = editor.document();
    set_cut(next, reach.direction, 0.5 * (reach.from_mm + reach.to_mm));
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command move_cut(std::string name, double step, std::vector<DefaultKey> keys) {
  Command out{std::move(name), "group.cuts", std::move(keys)};
  out.repeats = true;
  out.enabled = [](const Editor& editor) { return !editor.document().clips.empty(); };
  out.run = [step, why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    const Workplace::Reach reach = editor.place().reach_to_viewer();
    next.clips.back().distance_mm += step * (reach.to_mm - reach.from_mm);
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command no_cuts() {
  Command out{"no_cuts", "group.cuts", {{"shift+h"}}};
  out.enabled = [](const Editor& editor) { return !editor.document().clips.empty(); };
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    next.clips.clear();
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command fog() {
  Command out{"fog", "group.cuts", {}, "arg.percent"};
  out.values = {"0", "60"};
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    DUBSAR_ASSIGN(const double percent, number_argument("fog", text, 0.0, 100.0));
    Document next = editor.document();
    next.fog = 0.01 * percent;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

}  // namespace

const Cut* cut_across(const Document& document, const glm::dvec3& direction) {
  const auto at = std::find_if(document.clips.begin(), document.clips.end(),
                               [&](const Cut& cut) { return cut.on && across(cut, direction); });
  return at == document.clips.end() ? nullptr : &*at;
}

std::vector<Command> section_commands() {
  std::vector<Command> out;
  out.push_back(cut());
  out.push_back(cut_box());
  out.push_back(cut_handles());
  out.push_back(section());
  out.push_back(cut_here());
  out.push_back(move_cut("cut_deeper", -kStep, {{"]"}}));
  out.push_back(move_cut("cut_back", kStep, {{"["}}));
  out.push_back(no_cuts());
  out.push_back(fog());
  return out;
}

}  // namespace dubsar::app
