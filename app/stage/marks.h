#pragma once
// How measures, notes and places that were clicked stand on the surface: as lines and labels of a scene.

#include "app/document/ui_state.h"
#include "app/stage/stage.h"

namespace dubsar::app {

inline constexpr double kMarkLettersPx = 19.0;  ///< of a label on a plain monitor
/// Of measures and of what is written. On their ground, which hides as much of the surface, both are read whatever lies
/// behind: contrast of at least 4.5 (WCAG 2.2, 1.4.3).
inline constexpr Rgb8 kMeasuredColor{0xe8, 0xb4, 0x4c}, kWrittenColor{0xf4, 0xf0, 0xe8};
inline constexpr double kMarkPlate = 0.94;

/// Those of parts that are shown, where their parts stand. `font` outlives the pictures of them. `scale` times as large
/// as on a plain monitor.
Marks marks_of(const Document& document, const UiState& ui, const PartLooks& parts, LabelFont& font,
               double scale = 1.0);

/// The wedges of parts that are shown, where their parts stand: those of the program, of people, and the chosen one in
/// a colour each, the darkest first; `chosen`: its number, 0: none.
std::vector<LinesItem> wedge_lines(const Document& document, std::size_t chosen, const PartLooks& parts,
                                   double scale = 1.0);

/// The middle of a path, by its length.
glm::dvec3 middle_of(const std::vector<glm::dvec3>& path_mm);

}  // namespace dubsar::app
