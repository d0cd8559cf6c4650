#pragma once
// What is open in a window and what its pointer does. Plain values: not part of the document, and not undone.

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/document/document.h"
#include "app/document/export_choice.h"

namespace dubsar::app {

/// A place on the surface, in mm of the scan.
struct SurfacePin {
  glm::dvec3 at_mm{0.0}, normal{0.0, 0.0, 1.0};
  std::string part{};     ///< that it lies on; empty: none of them
  std::string side{};     ///< that looks its way: "obverse" ...
  bool inferred = false;  ///< the scan shows no surface there
  friend bool operator==(const SurfacePin&, const SurfacePin&) = default;
};

/// Light that goes round the picture.
struct LightSweep {
  double elevation_deg = 15.0, period_s = 8.0;
  friend bool operator==(const LightSweep&, const LightSweep&) = default;
};

/// Where the pointer is, what follows it, and what there is for it to take.
struct Pointing {
  double magnify = 0.0;            ///< of the glass; 0: there is none
  bool cursor = false;             ///< a ring on the surface
  bool cut_box = false;            ///< the box of cuts, with a handle for each side
  std::size_t notes = 0;           ///< that clicks have placed: each time what is typed next is its text
  std::size_t wedge = 0;           ///< which is chosen, by its number; 0: none
  bool wedges = true;              ///< they are drawn on the surface
  std::optional<glm::dvec2> at{};  ///< heights of the window from its middle, x to the right, y up; none: not seen
  friend bool operator==(const Pointing&, const Pointing&) = default;
};

/// The dialogue that opens files, what is asked about others, and how they are written.
struct Choosing {
  bool open = false;
  bool beside = false;       ///< for what stands beside the present one
  std::string folder{};      ///< that is looked into; empty: the one of the present file
  std::size_t deleting = 0;  ///< work set aside that goes when it is said again, counted from 1; 0: none
  ExportChoice publishing{};
  friend bool operator==(const Choosing&, const Choosing&) = default;
};

/// All of it.
struct UiState {
  bool help = false;
  bool panels = false;
  bool palette = false;  ///< all commands by typing
  Choosing choosing{};
  double ui_scale = 0.0;              ///< of letters and panels; 0: as the monitor wants it
  bool legend = true;                 ///< of colours that tell figures
  bool leaving = false;               ///< asked whether to end with work in it
  std::string drawer{};               ///< of the panels; empty: none is open
  std::string tool{"turn"};           ///< what a click does
  std::vector<SurfacePin> pending{};  ///< places that the tool was told and still waits with
  std::optional<LightSweep> sweep{};
  Pointing pointing{};
  std::optional<Document> compared;  ///< a state that stands beside the present one
  bool linked = true;                ///< both are seen from the same place, by the same light
  std::size_t note = 0;              ///< which is open, counted from 1; 0: none
  friend bool operator==(const UiState&, const UiState&) = default;
};

}  // namespace dubsar::app
