#pragma once
// What stands around the surface in a window: a line above it, tools at its left, the strip of sides below it, drawers
// at its right, and all commands by typing. Panels never change anything: they post commands.

#include <cstdint>
#include <string>
#include <vector>

#include "app/commands/editor.h"
#include "app/commands/key_table.h"
#include "app/document/job_state.h"
#include "app/panels/open_dialogue.h"
#include "app/panels/slice_panel.h"

namespace dubsar::app {

/// The line above the surface.
struct PanelLine {
  std::string title{}, display{}, language{};
  std::string side{};          ///< the one that faces the viewer
  std::string undo{}, redo{};  ///< what the next one is about; empty: there is none
  friend bool operator==(const PanelLine&, const PanelLine&) = default;
};

/// Work that was found and is not that of the surface (app/document/other_work.h).
struct OtherWorkRow {
  std::string day{}, name{};  ///< when it was set aside, as 2026-11-27 (empty: it was not); of the surface's file
  std::string marks{};        ///< what is in it: "2 notes, 1 measure"
  bool taken = false;         ///< all of it is here already
  friend bool operator==(const OtherWorkRow&, const OtherWorkRow&) = default;
};

/// All that panels show, as values.
struct PanelState {
  PanelLine line{};
  Document document{};
  UiState ui{};
  EvidenceShares evidence{};
  SlicePanelState slices{};
  FilesState files{};
  std::optional<JobState> exporting{};      ///< what is being written
  std::optional<JobState> finding{};        ///< wedges that are being looked for
  std::vector<OtherWorkRow> others{};       ///< while their drawer is open
  bool playing = false;                     ///< the document's film
  std::vector<std::uint32_t> thumbnails{};  ///< names of textures, one for each keyframe; 0: not made yet
  double thumbnail_aspect = 1.6;            ///< their width by their height
  double mm_per_px = 0.0;                   ///< of the object, in its middle, by pixels of the layout; 0: no scale bar
  bool faint = false;                       ///< something moves: the surface owns the window
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
