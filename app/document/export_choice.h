#pragma once
// How a session's surface is written for print, as people choose it in the window. Not part of the document.

#include <string>

namespace dubsar::app {

struct ExportChoice {
  double width_mm = 85.0;        ///< of an article's figure: a column
  double dpi = 600.0;            ///< of figure and plate
  std::string ground = "white";  ///< white, grey, black, none
  bool scale_bar = true, labels = false;
  std::string hand = "outlined";  ///< style of hand copies
  friend bool operator==(const ExportChoice&, const ExportChoice&) = default;
};

}  // namespace dubsar::app
