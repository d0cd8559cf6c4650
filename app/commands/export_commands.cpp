// Commands that write what is published of a tablet: a plate, a hand copy, an article's figure, a film, a page, a
// model.

#include <fmt/format.h>

#include <algorithm>

#include "app/commands/command_table.h"
#include "app/commands/export_words.h"
#include "app/commands/number_argument.h"

namespace dubsar::app {
namespace {

constexpr Text kExportGroup = "group.export";

Command write_published() {
  Command out{"export", kExportGroup, {}, "arg.export"};
  for (const ExportKind& kind : kExportKinds) out.values.emplace_back(kind.name);
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    const auto [kind, path] = first_word(text);
    const bool known = std::any_of(kExportKinds.begin(), kExportKinds.end(),
                                   [&](const ExportKind& each) { return each.name == kind; });
    if (!known)
      return fail(ErrorKind::kUsage,
                  "export: \"{}\" found, expected plate, handcopy, figure, film, report, stl or atf, and a file", kind);
    return editor.place().publish(kind, path);
  };
  return out;
}

Command stop_writing() {
  Command out{"stop_export", kExportGroup, {}};
  out.run = [](Editor& editor, const std::string&) -> Result<void> {
    if (!editor.place().stop_publishing()) editor.place().say(tr("export.none"));
    return {};
  };
  return out;
}

/// One word of how it is written.
Command choose_how() {
  Command out{"export_as", kExportGroup, {}, "arg.export_as"};
  out.values = {"ground white",  "ground grey", "ground black",  "ground none", "scale-bar", "labels",
                "hand outlined", "hand filled", "hand weighted", "width 85",    "dpi 600"};
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    const auto [what, value] = first_word(text);
    ExportChoice& choice = editor.ui().choosing.publishing;
    const auto one_of = [&](std::initializer_list<const char*> words) {
      return std::any_of(words.begin(), words.end(), [&](const char* word) { return value == word; });
    };
    if (what == "width") {
      DUBSAR_ASSIGN(choice.width_mm, number_argument("export_as width", value, kFigureMm.least, kFigureMm.most));
    } else if (what == "dpi") {
      DUBSAR_ASSIGN(choice.dpi, number_argument("export_as dpi", value, kPlateDpi.least, kPlateDpi.most));
    } else if (what == "ground" && one_of({"white", "grey", "black", "none"})) {
      choice.ground = value;
    } else if (what == "hand" && one_of({"outlined", "filled", "weighted"})) {
      choice.hand = value;
    } else if (text == "scale-bar") {
      choice.scale_bar = !choice.scale_bar;
    } else if (text == "labels") {
      choice.labels = !choice.labels;
    } else {
      return fail(
          ErrorKind::kUsage,
          "export_as: \"{}\" found, expected width MM, dpi N, ground white, grey, black or none, hand outlined, "
          "filled or weighted, scale-bar, or labels",
          text);
    }
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> export_commands() {
  std::vector<Command> out;
  out.push_back(write_published());
  out.push_back(stop_writing());
  out.push_back(choose_how());
  return out;
}

}  // namespace dubsar::app
