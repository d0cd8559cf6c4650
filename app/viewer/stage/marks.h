#pragma once
// How measures, notes and places that were clicked stand on the surface: as lines and labels of a scene.

#include "app/commands/editor.h"
#include "app/viewer/stage/stage.h"

namespace dubsar::app {

inline constexpr double kMarkLettersPx = 19.0;  ///< of a label on a plain monitor

/// Those of parts that are shown, where their parts stand. `font` outlives the pictures of them. `scale` times as large
/// as on a plain monitor.
Marks marks_of(const Document& document, const Desk& desk, const PartLooks& parts, LabelFont& font, double scale = 1.0);

/// The middle of a path, by its length.
glm::dvec3 middle_of(const std::vector<glm::dvec3>& path_mm);

}  // namespace dubsar::app
