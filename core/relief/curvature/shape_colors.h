#pragma once
// Colours of the shape classes (paper, figure 14): one table for exporters and renderers, so that a picture and a PLY
// file of the same surface look the same.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

enum class ShapeColors {
  kTable,  ///< a hue per shape, from violet cups over green saddles to red caps; chroma grows with curvedness (14a)
  kBlackWhite,  ///< concave dark, convex light (14b)
  kSkySun,      ///< concave in sky-blue shadow, convex in the orange of the sun (14c)
};

using ShapeRgb = std::array<std::uint8_t, 3>;  ///< sRGB-coded

/// Colours of the classes 0..126 in full light; entry 127 repeats 0. Flat is a neutral grey of L* = 60; lightness rises
/// from cup to cap, evenly in CIE L*, the more the larger the curvedness. Computed once; threads.
const std::array<ShapeRgb, 128>& shape_color_table(ShapeColors colors);

/// A colour under ambient light `ao`, 0..63: each sRGB value times ao / 63 (figure 14d, e).
constexpr ShapeRgb shade(ShapeRgb color, std::uint8_t ao) noexcept {
  for (std::uint8_t& c : color) c = static_cast<std::uint8_t>((c * (ao < 63 ? ao : 63) + 31) / 63);
  return color;
}

/// One colour per vertex from its shape class and ambient occlusion; either may be empty: all flat, or all in full
/// light. Both of the same length otherwise. Values beyond 126 and 63 count as 0 and 63.
std::vector<ShapeRgb> shape_vertex_colors(ShapeColors colors, std::span<const std::uint8_t> shape,
                                          std::span<const std::uint8_t> ao);

}  // namespace dubsar
