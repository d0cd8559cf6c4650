#pragma once
// The six sides of the box of cuts: their names, and which cut of a document is whose.

#include <array>
#include <glm/vec3.hpp>
#include <string_view>

#include "app/document/document.h"

namespace dubsar::app {

struct BoxSide {
  std::string_view name;
  glm::dvec3 outward;  ///< of the home view: right, up, to the viewer
};

/// As cut_box takes them: one after the other two that face each other.
inline constexpr std::array<BoxSide, 6> kBoxSides{{{"left", {-1, 0, 0}},
                                                   {"right", {1, 0, 0}},
                                                   {"bottom", {0, -1, 0}},
                                                   {"top", {0, 1, 0}},
                                                   {"back", {0, 0, -1}},
                                                   {"front", {0, 0, 1}}}};

/// The cut across a direction of the scan; null: there is none.
const Cut* cut_across(const Document& document, const glm::dvec3& direction);

}  // namespace dubsar::app
