#pragma once
// A monitor as the window system tells of it; plain data.

#include <string>

namespace dubsar {

struct Monitor {
  std::string name;
  int x = 0, y = 0;                        ///< place on the desktop
  int width_px = 0, height_px = 0;         ///< of its current mode
  double width_mm = 0.0, height_mm = 0.0;  ///< 0 when the monitor does not say
  double refresh_hz = 0.0;
  bool primary = false;
};

}  // namespace dubsar
