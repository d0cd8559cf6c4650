#pragma once
// What stands around the surface in a window: a line above it, the strip of
// sides below it, and drawers at its right for parts, light and style. Panels
// never change anything: they post commands.

#include <string>
#include <vector>

#include "app/commands/key_table.h"
#include "app/document/document.h"

namespace dubsar::app {

/// All that panels show, as values.
struct PanelState {
  std::string title, display;
  std::string drawer;  ///< which is open: "parts", "light", "style"; empty: none
  std::vector<Part> parts;
  bool can_unpack = false;
  double unpack = 0.0;
  LightPlace light;
  std::string style;
  bool occlusion = true;
  std::string undo, redo;  ///< what the next one is about; empty: there is none
  std::string side;        ///< the one that faces the viewer
  double mm_per_px = 0.0;  ///< of the object, in its middle, by pixels of the
                           ///< layout; 0: no scale bar
  bool faint = false;      ///< something moves: the surface owns the window
  friend bool operator==(const PanelState&, const PanelState&) = default;
};

/// Draws them into the current Dear ImGui frame, `width` x `height` pixels of
/// its layout, and appends what was asked for. `keys` says which key does the
/// same as a button.
void draw_panels(const PanelState& state, const KeyTable& keys, float width, float height,
                 std::vector<std::string>& commands);

/// The longest of 1, 2, 5, 10, 20 ... (mm) that is at most `most_px` long.
double scale_bar_mm(double mm_per_px, double most_px);

}  // namespace dubsar::app
