// Commands for how a style is shaded: mixed with another one, its ridges lifted out, its colours and their legend.

#include <algorithm>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"

namespace dubsar::app {
namespace {

constexpr std::array<std::string_view, 4> kColours{"designed", "blue-orange", "cividis", "grey"};

Command blend(const std::vector<std::string>& names) {
  Command out{"blend", "group.style", {{"shift+b", "raking 50"}}};
  out.argument = "arg.style_percent";
  out.values = {"raking 50", "msii 30", "raking 0"};
  out.run = [names, why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const auto [name, share] = first_word(text);
    if (std::find(names.begin(), names.end(), name) == names.end())
      return fail(ErrorKind::kUsage, "blend: \"{}\" found, expected a style such as raking, and 0 to 100", name);
    DUBSAR_ASSIGN(const double percent, number_argument("blend", share, 0.0, 100.0));
    Document next = editor.document();
    next.style.other = percent > 0 ? name : std::string();
    next.style.share = 0.01 * percent;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command radiance() {
  Command out{"radiance", "group.style", {{"r"}}};
  out.argument = "arg.to_200";
  out.values = {"0", "100"};
  out.optional = true;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    double percent = editor.document().style.radiance > 0 ? 0.0 : 100.0;
    if (!text.empty()) {
      DUBSAR_ASSIGN(percent, number_argument("radiance", text, 0.0, 200.0));
    }
    Document next = editor.document();
    next.style.radiance = 0.01 * percent;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command colours() {
  Command out{"colours", "group.style", {{"shift+c"}}};
  out.argument = "arg.colours";
  for (const std::string_view name : kColours) out.values.emplace_back(name);
  out.closed = out.optional = true;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    Document next = editor.document();
    const auto* const at = std::find(kColours.begin(), kColours.end(), next.style.colours);
    const std::size_t now = at == kColours.end() ? 0 : static_cast<std::size_t>(at - kColours.begin());
    next.style.colours = text.empty() ? std::string(kColours[(now + 1) % kColours.size()]) : text;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command legend() {
  Command out{"legend", "group.style", {{"shift+l"}}};
  out.run = [](Editor& editor, const std::string&) -> Result<void> {
    editor.ui().legend = !editor.ui().legend;
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> shade_commands(const std::vector<std::string>& styles) {
  std::vector<Command> out;
  if (!styles.empty()) out.push_back(blend(styles));
  out.push_back(radiance());
  out.push_back(colours());
  out.push_back(legend());
  return out;
}

}  // namespace dubsar::app
