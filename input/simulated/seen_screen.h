#pragma once
// What a simulated person sees of a display.

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "input/navigation/view_state.h"

namespace dubsar {

/// A picture beside the object that shows a gesture.
enum class SeenLesson : std::uint8_t { kNone, kShowHand, kGrabAndMove, kSwipe, kNearer, kRestOnSign };

/// Places are heights of the panel from its middle, to the right and up.
struct SeenScreen {
  ViewState view{};
  SeenLesson lesson = SeenLesson::kNone;
  bool opened = false;                          ///< what was inside is to be seen
  std::optional<glm::dvec2> my_mark{};          ///< where a mark shows one's own hand
  bool arrow_up = false;                        ///< an arrow rises where the mark of a hand was
  std::optional<glm::dvec2> sign{};             ///< something that looks as if it could be touched
  double sign_radius = 0.0, sign_filled = 0.0;  ///< 0..1: something goes on there
};

}  // namespace dubsar
