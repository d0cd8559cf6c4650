#pragma once
// Where on the panel what is shown stands.

#include <glm/vec2.hpp>
#include <vector>

#include "app/document/document.h"
#include "app/stage/stage.h"

namespace dubsar::app {

/// A rectangle of the panel's plane, mm of the screen frame, to the right and up.
struct ScreenRect {
  glm::dvec2 min_mm{0.0}, max_mm{0.0};
};

/// One for each place where visible parts of the document stand, as the stage shows them: parts that are together count
/// as one, and so does a surface without parts. Empty: nothing is visible. Each is that of the whole surface's box,
/// moved as its parts are.
std::vector<ScreenRect> object_places(const Stage& stage, const Document& document, const PartLooks& looks);

}  // namespace dubsar::app
