// Commands for what is seen: light, style, parts, and how far the envelope is lifted.

#include <algorithm>
#include <charconv>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"

namespace dubsar::app {
namespace {

constexpr double kRakingDeg = 15.0;  // low enough for shadows in every wedge
constexpr std::array<std::string_view, 8> kCompass{"top",    "upper_right", "right", "lower_right",
                                                   "bottom", "lower_left",  "left",  "upper_left"};
constexpr double kUnpackStep = 0.05;

Command light_from() {
  Command out{"light_from", "group.light", {}};
  out.argument = "arg.direction";
  for (std::size_t i = 0; i < kCompass.size(); ++i) {
    out.values.emplace_back(kCompass[i]);
    out.keys.push_back({fmt::format("alt+{}", i + 1), std::string(kCompass[i])});
  }
  out.closed = out.steers = true;
  out.run = [why = out.name](Editor& editor, const std::string& name) -> Result<void> {
    Document next = editor.document();
    const auto* const at = std::find(kCompass.begin(), kCompass.end(), name);
    next.light = {45.0 * static_cast<double>(at - kCompass.begin()), kRakingDeg};
    editor.change(std::move(next), why, Transition::kGlide);
    return {};
  };
  return out;
}

Command light() {
  Command out{"light", "group.light", {}};
  out.argument = "arg.light";
  out.values = {"315,25", "0,90"};
  out.steers = true;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const std::size_t comma = std::min(text.find(','), text.size());
    DUBSAR_ASSIGN(const double azimuth, number_argument("light", text.substr(0, comma), 0.0, 360.0));
    DUBSAR_ASSIGN(const double elevation,
                  number_argument("light", text.substr(std::min(comma + 1, text.size())), 5.0, 90.0));
    Document next = editor.document();
    next.light = {azimuth, elevation};
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command style(std::vector<std::string> names) {
  Command out{"style", "group.style", {}};
  out.argument = "arg.style";
  out.values = std::move(names);
  out.closed = true;
  out.run = [why = out.name](Editor& editor, const std::string& name) -> Result<void> {
    Document next = editor.document();
    next.style.name = name;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command next_style(std::vector<std::string> names) {
  Command out{"next_style", "group.style", {{"s"}}};
  out.run = [names = std::move(names), why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    const auto at = std::find(names.begin(), names.end(), next.style.name);
    next.style.name = names[at == names.end() ? 0 : static_cast<std::size_t>(at + 1 - names.begin()) % names.size()];
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command occlusion() {
  Command out{"occlusion", "group.style", {{"o"}}};
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    next.style.occlusion = !next.style.occlusion;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command evidence() {
  Command out{"evidence", "group.style", {{"e"}}};
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    next.style.evidence = !next.style.evidence;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command hatch() {
  Command out{"hatch", "group.style", {}, "arg.hatch"};
  out.values = {"sepia", "blue"};
  out.closed = out.optional = true;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    Document next = editor.document();
    next.style.hatch = !text.empty() ? text : next.style.hatch == "blue" ? "sepia" : "blue";
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command strength() {
  Command out{"strength", "group.style", {}};
  out.argument = "arg.to_200";
  out.values = {"0", "100", "200"};
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    DUBSAR_ASSIGN(const double percent, number_argument("strength", text, 0.0, 200.0));
    Document next = editor.document();
    next.style.strength = 0.01 * percent;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// The part of this name or number. kUsage.
Result<Part*> part_of(std::string_view command, Document& document, const std::string& wanted) {
  for (Part& each : document.parts)
    if (each.name == wanted) return &each;
  DUBSAR_ASSIGN(const std::size_t at, place_argument(command, wanted, document.parts.size()));
  return &document.parts[at];
}

Command part_opacity() {
  Command out{"part_opacity", "group.parts", {}};
  out.argument = "arg.part_percent";
  out.values = {"1 50", "1 100"};
  out.enabled = [](const Editor& editor) { return !editor.document().parts.empty(); };
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const std::size_t space = std::min(text.rfind(' '), text.size());
    DUBSAR_ASSIGN(const double percent,
                  number_argument("part_opacity", text.substr(std::min(space + 1, text.size())), 0.0, 100.0));
    Document next = editor.document();
    DUBSAR_ASSIGN(Part* const which, part_of("part_opacity", next, text.substr(0, space)));
    which->opacity = 0.01 * percent;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command part_colour() {
  Command out{"part_colour", "group.parts", {}};
  out.argument = "arg.part_colour";
  out.values = {"1 d9a441", "1 none"};
  out.enabled = [](const Editor& editor) { return !editor.document().parts.empty(); };
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const std::size_t space = std::min(text.rfind(' '), text.size());
    const std::string colour = text.substr(std::min(space + 1, text.size()));
    unsigned value = 0xffffff;  // white: as the style has it
    const auto [end, error] = std::from_chars(colour.data(), colour.data() + colour.size(), value, 16);
    if (colour != "none" && (error != std::errc() || end != colour.data() + colour.size() || colour.size() != 6))
      return fail(ErrorKind::kUsage, "part_colour: \"{}\" found, expected a colour such as d9a441, or none", colour);
    if (colour == "none") value = 0xffffff;
    Document next = editor.document();
    DUBSAR_ASSIGN(Part* const which, part_of("part_colour", next, text.substr(0, space)));
    which->colour = {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255),
                     static_cast<std::uint8_t>(value & 255)};
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command part_offset() {
  Command out{"part_offset", "group.parts", {}};
  out.argument = "arg.part_offset";
  out.values = {"1 0,0,10", "1 0,0,0"};
  out.enabled = [](const Editor& editor) { return !editor.document().parts.empty(); };
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const std::size_t space = std::min(text.rfind(' '), text.size());
    std::string rest;
    DUBSAR_ASSIGN(const auto places,
                  points_argument("part_offset", text.substr(std::min(space + 1, text.size())), 1, rest));
    Document next = editor.document();
    DUBSAR_ASSIGN(Part* const which, part_of("part_offset", next, text.substr(0, space)));
    which->offset_mm = places[0];
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command part() {
  Command out{"part", "group.parts", {}};
  out.argument = "arg.part";
  out.values = {"1", "2", "3", "4"};
  for (const std::string& number : out.values) out.keys.push_back({"ctrl+" + number, number});
  out.enabled = [](const Editor& editor) { return editor.document().parts.size() > 1; };
  out.run = [why = out.name](Editor& editor, const std::string& wanted) -> Result<void> {
    Document next = editor.document();
    std::size_t number = 0;
    std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    for (std::size_t i = 0; i < next.parts.size(); ++i)
      if (next.parts[i].name == wanted || i + 1 == number) {
        next.parts[i].visible = !next.parts[i].visible;
        editor.change(std::move(next), why);
        return {};
      }
    return fail(ErrorKind::kUsage, "part: \"{}\" found, expected a name or 1 to {}", wanted, next.parts.size());
  };
  return out;
}

Command all_parts() {
  Command out{"all_parts", "group.parts", {{"ctrl+0"}}};
  out.enabled = [](const Editor& editor) { return editor.document().parts.size() > 1; };
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    for (Part& each : next.parts) each.visible = true;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// `step` 0: to the percentage that is said.
Command unpack(std::string name, double step, std::vector<DefaultKey> keys) {
  Command out{std::move(name), "group.parts", std::move(keys)};
  if (step == 0.0) {
    out.argument = "arg.percent";
    out.values = {"0", "50", "100"};
  }
  out.repeats = step != 0.0;
  out.enabled = [](const Editor& editor) { return can_unpack(editor.document()); };
  out.run = [step, what = out.name](Editor& editor, const std::string& argument) -> Result<void> {
    Document next = editor.document();
    if (step == 0.0) {
      DUBSAR_ASSIGN(const double percent, number_argument(what, argument, 0.0, 100.0));
      next.unpack = 0.01 * percent;
    } else {
      next.unpack = std::clamp(next.unpack + step, 0.0, 1.0);
    }
    editor.change(std::move(next), what);
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> look_commands(const std::vector<std::string>& styles) {
  std::vector<Command> out;
  out.push_back(light_from());
  out.push_back(light());
  if (!styles.empty()) out.push_back(style(styles));
  if (!styles.empty()) out.push_back(next_style(styles));
  out.push_back(occlusion());
  out.push_back(evidence());
  out.push_back(hatch());
  out.push_back(strength());
  out.push_back(part());
  out.push_back(part_opacity());
  out.push_back(part_colour());
  out.push_back(part_offset());
  out.push_back(all_parts());
  out.push_back(unpack("unpack", 0.0, {}));
  out.push_back(unpack("unpack_more", kUnpackStep, {{"u"}}));
  out.push_back(unpack("unpack_less", -kUnpackStep, {{"shift+u"}}));
  return out;
}

}  // namespace dubsar::app
