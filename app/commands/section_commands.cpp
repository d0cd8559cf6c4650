// Commands that cut parts of what is seen away, and let the far side fade.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"

namespace dubsar::app {
namespace {

constexpr std::size_t kMostCuts = 6;  // of eight planes that the renderer has
constexpr double kStep = 0.02;        // of the object's depth

/// The cut across a direction, once: a second one of the same direction takes its place.
void set_cut(Document& document, const glm::dvec3& normal, double distance_mm) {
  const auto same = std::find_if(document.clips.begin(), document.clips.end(),
                                 [&](const Cut& cut) { return glm::distance(cut.normal, normal) < 1e-9; });
  if (same != document.clips.end()) {
    *same = {normal, distance_mm, true};
  } else {
    if (document.clips.size() == kMostCuts) document.clips.erase(document.clips.begin());
    document.clips.push_back({normal, distance_mm, true});
  }
}

Command cut() {
  Command out{"cut", "Cuts", "cut away from a side, in percent of the object", {}, "a side and 0 to 100"};
  out.values = {"front 20", "left 50", "front 0"};
  out.run = [why = out.words](Editor& editor, const std::string& text) -> Result<void> {
    constexpr std::array<std::pair<std::string_view, glm::dvec3>, 6> kSides{{{"front", {0, 0, 1}},
                                                                             {"back", {0, 0, -1}},
                                                                             {"left", {-1, 0, 0}},
                                                                             {"right", {1, 0, 0}},
                                                                             {"top", {0, 1, 0}},
                                                                             {"bottom", {0, -1, 0}}}};
    const auto [side, share] = first_word(text);
    const auto* const at =
        std::find_if(kSides.begin(), kSides.end(), [&](const auto& row) { return row.first == side; });
    if (at == kSides.end())
      return fail(ErrorKind::kUsage, "cut: \"{}\" found, expected front, back, left, right, top or bottom", side);
    DUBSAR_ASSIGN(const double percent, number_argument("cut", share, 0.0, 100.0));
    const Workplace::Reach reach = editor.place().reach(at->second);
    Document next = editor.document();
    set_cut(next, reach.direction, reach.to_mm - 0.01 * percent * (reach.to_mm - reach.from_mm));
    if (percent == 0.0) next.clips.pop_back();
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// One number for all sides, or one for each: left, right, bottom, top, back, front.
Command cut_box() {
  Command out{"cut_box", "Cuts", "cut away from all six sides, in percent of the object", {}};
  out.argument = "0 to 49, or six of them: left,right,bottom,top,back,front";
  out.values = {"10", "0,0,0,0,0,40", "0"};
  out.run = [why = out.words](Editor& editor, const std::string& text) -> Result<void> {
    constexpr std::array<glm::dvec3, 6> kOutward{{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
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
    for (std::size_t side = 0; side < percent.size(); ++side) {
      if (percent[side] == 0.0) continue;
      const Workplace::Reach reach = editor.place().reach(kOutward[side]);
      set_cut(next, reach.direction, reach.to_mm - 0.01 * percent[side] * (reach.to_mm - reach.from_mm));
    }
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// Whether what is cut through is filled.
Command section() {
  Command out{"section", "Cuts", "fill what is cut through, or look inside", {{"shift+x"}}};
  out.run = [why = out.words](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    next.style.section = !next.style.section;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command cut_here() {
  Command out{"cut_here", "Cuts", "cut through the middle, across the view", {{"h"}}};
  out.run = [why = out.words](Editor& editor, const std::string&) -> Result<void> {
    const Workplace::Reach reach = editor.place().reach_to_viewer();
    Document next = editor.document();
    set_cut(next, reach.direction, 0.5 * (reach.from_mm + reach.to_mm));
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command move_cut(std::string name, std::string words, double step, std::vector<DefaultKey> keys) {
  Command out{std::move(name), "Cuts", std::move(words), std::move(keys)};
  out.repeats = true;
  out.enabled = [](const Editor& editor) { return !editor.document().clips.empty(); };
  out.run = [step, why = out.words](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    const Workplace::Reach reach = editor.place().reach_to_viewer();
    next.clips.back().distance_mm += step * (reach.to_mm - reach.from_mm);
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command no_cuts() {
  Command out{"no_cuts", "Cuts", "take all cuts away", {{"shift+h"}}};
  out.enabled = [](const Editor& editor) { return !editor.document().clips.empty(); };
  out.run = [why = out.words](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    next.clips.clear();
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command fog() {
  Command out{"fog", "Cuts", "how much the far side fades, in percent", {}, "0 to 100"};
  out.values = {"0", "60"};
  out.run = [why = out.words](Editor& editor, const std::string& text) -> Result<void> {
    DUBSAR_ASSIGN(const double percent, number_argument("fog", text, 0.0, 100.0));
    Document next = editor.document();
    next.fog = 0.01 * percent;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> section_commands() {
  std::vector<Command> out;
  out.push_back(cut());
  out.push_back(cut_box());
  out.push_back(section());
  out.push_back(cut_here());
  out.push_back(move_cut("cut_deeper", "cut deeper", -kStep, {{"]"}}));
  out.push_back(move_cut("cut_back", "cut less deep", kStep, {{"["}}));
  out.push_back(no_cuts());
  out.push_back(fog());
  return out;
}

}  // namespace dubsar::app
