#pragma once
// How a session's surface is written for print, as people choose it in the window. Not part of the document.

#include <string>

namespace dubsar::app {

/// What may be asked of print, from the command line as from the window.
struct PrintBounds {
  double least, most;
};
inline constexpr PrintBounds kPlateDpi{50.0, 4800.0};  ///< at life size: plates, seals
inline constexpr PrintBounds kFigureDpi{20.0, 9600.0}, kFigureMm{5.0, 2000.0};

struct ExportChoice {
  double width_mm = 85.0;        ///< of an article's figure: a column
  double dpi = 600.0;            ///< of figure and plate
  std::string ground = "white";  ///< white, grey, black, none
  bool scale_bar = true, labels = false;
  std::string hand = "outlined";  ///< style of hand copies
  friend bool operator==(const ExportChoice&, const ExportChoice&) = default;
};

}  // namespace dubsar::app
