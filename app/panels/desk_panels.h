#pragma once
// What stands around the surface in a window: a line above it, tools at its left, the strip of sides below it, drawers
// at its right, and all commands by typing. Panels never change anything: they post commands.

#include <string>
#include <vector>

#include "app/commands/key_table.h"
#include "app/document/document.h"

namespace dubsar::app {

/// All that panels show, as values.
struct PanelState {
  std::string title, display;
  std::string drawer;  ///< which is open: "parts", "light" ...; empty: none
  std::string tool;    ///< what a click does
  std::vector<Part> parts;
  bool can_unpack = false;
  double unpack = 0.0;
  LightPlace light;
  std::string style;
  bool occlusion = true, evidence = true;
  double strength = 1.0;
  double measured_mm2 = 0.0, inferred_mm2 = 0.0;  ///< of the surface
  std::vector<Measure> measures;
  std::vector<Note> notes;
  std::size_t note = 0;  ///< which is open, counted from 1; 0: none
  std::size_t cuts = 0;
  double fog = 0.0;
  std::vector<double> keyframes_s;  ///< their times
  bool playing = false;
  bool panels = true, palette = false;  ///< which are shown
  std::string undo, redo;               ///< what the next one is about; empty: there is none
  std::string side;                     ///< the one that faces the viewer
  double mm_per_px = 0.0;               ///< of the object, in its middle, by pixels of the
                                        ///< layout; 0: no scale bar
  bool faint = false;                   ///< something moves: the surface owns the window
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
