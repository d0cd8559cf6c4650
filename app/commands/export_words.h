#pragma once
// What is said to this program itself so that it writes a plate, a hand copy, a figure ... of a session's surface.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/document.h"
#include "app/document/export_choice.h"

namespace dubsar::app {

/// What can be written, in the order of the drawer, and the end of the file's name beside the surface's.
struct ExportKind {
  std::string_view name, ending;
};
inline constexpr std::array<ExportKind, 7> kExportKinds{{{"plate", "_plate.tif"},
                                                         {"handcopy", "_handcopy.svg"},
                                                         {"figure", "_figure.png"},
                                                         {"film", "_film.mp4"},
                                                         {"report", "_report.html"},
                                                         {"stl", ".stl"},
                                                         {"atf", ".atf"}}};

/// Files that it goes between. `session`: the document in a file.
struct ExportFiles {
  std::string surface, session, out;
};

/// The arguments behind the program's name; `side`: of kSideNames, that a figure shows. Empty for what is no kind, or
/// is written by the window itself (atf).
std::vector<std::string> export_words(std::string_view kind, const ExportFiles& files, const ExportChoice& choice,
                                      const Document& document, std::string_view side);

}  // namespace dubsar::app
