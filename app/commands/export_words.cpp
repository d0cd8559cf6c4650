#include "app/commands/export_words.h"

#include <fmt/format.h>

#include <algorithm>

namespace dubsar::app {
namespace {

using WordList = std::vector<std::string>;

/// The view of `render` that shows a side.
std::string view_of_side(std::string_view side) {
  if (side == "obverse") return "front";
  return side == "reverse" ? "back" : std::string(side);
}

/// Parts that are shown, where not all of them are.
WordList shown_parts(const Document& document) {
  std::string names;
  bool all = true;
  for (const Part& part : document.parts) {
    if (part.visible) names += (names.empty() ? "" : ",") + part.name;
    all = all && part.visible;
  }
  return all || names.empty() ? WordList() : WordList{"--partition", names};
}

void append(WordList& words, const WordList& more) { words.insert(words.end(), more.begin(), more.end()); }

}  // namespace

std::vector<std::string> export_words(std::string_view kind, const ExportFiles& files, const ExportChoice& choice,
                                      const Document& document, std::string_view side) {
  const std::string dpi = fmt::format("{:g}", choice.dpi);
  const WordList to{"-o", files.out};
  WordList words;
  if (kind == "plate") {
    words = {"fatcross", files.surface, "--dpi", dpi, "--no-sides"};
    if (choice.ground != "none") append(words, {"--ground", choice.ground});
    if (choice.labels) words.emplace_back("--text");
  } else if (kind == "handcopy") {
    words = {"handcopy", files.surface, "--work", files.session, "--style", choice.hand};
    const std::string& title = document.edition.record.museum_number;
    if (!title.empty()) append(words, {"--title", title});
  } else if (kind == "figure") {
    words = {"render",     files.surface,
             "--view",     view_of_side(side),
             "--width-mm", fmt::format("{:g}", choice.width_mm),
             "--dpi",      dpi,
             "--ground",   choice.ground,
             "--style",    document.style.name,
             "--light",    fmt::format("{:.1f},{:.1f}", document.light.azimuth_deg, document.light.elevation_deg)};
    if (choice.scale_bar) words.emplace_back("--scale-bar");
    if (choice.labels) words.emplace_back("--labels");
    if (document.style.hatch == "blue") append(words, {"--hatch", "blue"});
    append(words, shown_parts(document));
  } else if (kind == "film") {
    words = {"animate", files.session, files.surface};
  } else if (kind == "report") {
    words = {"report", files.surface};
  } else if (kind == "stl") {
    words = {"export", files.surface, files.out};
    append(words, shown_parts(document));
    return words;
  } else {
    return {};
  }
  append(words, to);
  return words;
}

}  // namespace dubsar::app
