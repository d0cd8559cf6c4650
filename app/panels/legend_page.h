#pragma once
// The legend of a style whose colours tell a figure of the surface: a bar of its colours, numbers, and what they are.

#include <array>
#include <optional>
#include <string>

#include "core/compare/surface_difference.h"
#include "display/render/shading.h"

namespace dubsar::app {

struct LegendPicture {
  std::string name, unit;
  double from = -1.0, to = 1.0;
  std::array<Rgb8, kShapeRows> colors{};
  std::string figures{};  ///< of the whole surface; empty: none
  friend bool operator==(const LegendPicture&, const LegendPicture&) = default;
};

/// None for styles whose colours tell no figure. `difference`: that of the surface from the one beside it; null: none.
std::optional<LegendPicture> legend_of(const Style& style, const SurfaceDifference* difference = nullptr);

/// Draws it into the current Dear ImGui frame; its lower left corner stands at `left`, `bottom`.
void draw_legend(const LegendPicture& legend, float left, float bottom);

}  // namespace dubsar::app
