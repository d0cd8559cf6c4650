#include "core/relief/curvature/shape_colors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/system/parallel.h"
#include "core/relief/curvature/shape_class.h"

namespace dubsar {
namespace {

constexpr double kFlatLightness = 60.0;

/// Linear RGB of a CIE L*C*h colour (D65); outside [0, 1] where the display cannot show it.
glm::dvec3 linear_from_lch(double lightness, double chroma, double hue_deg) {
  const double hue = hue_deg * 0.017453292519943295;
  const double fy = (lightness + 16) / 116, fx = fy + chroma * std::cos(hue) / 500,
               fz = fy - chroma * std::sin(hue) / 200;
  const auto cube = [](double f) { return f > 6.0 / 29 ? f * f * f : (f - 16.0 / 116) * 3 * (6.0 / 29) * (6.0 / 29); };
  const double x = 0.95047 * cube(fx), y = cube(fy), z = 1.08883 * cube(fz);
  return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
          0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

/// Keeps lightness and hue, and as much of the chroma as the display can show.
ShapeRgb srgb_from_lch(double lightness, double chroma, double hue_deg) {
  glm::dvec3 linear = linear_from_lch(lightness, chroma, hue_deg);
  for (; chroma > 0.0; chroma = std::max(0.0, chroma - 0.5), linear = linear_from_lch(lightness, chroma, hue_deg))
    if (std::min({linear.x, linear.y, linear.z}) >= 0.0 && std::max({linear.x, linear.y, linear.z}) <= 1.0) break;
  ShapeRgb rgb{};
  for (int c = 0; c < 3; ++c) {
    const double v = std::clamp(linear[c], 0.0, 1.0);
    const double coded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    rgb[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(255 * coded));
  }
  return rgb;
}

ShapeRgb color_of(ShapeColors colors, std::uint8_t shape_class) {
  if (shape_class == 0) return srgb_from_lch(kFlatLightness, 0.0, 0.0);
  const int shape = shape_of(shape_class);
  const double strength = static_cast<double>(curvedness_step_of(shape_class) + 1) / kCurvednessSteps;
  const double convexity = (shape - 4) / 4.0 * strength;  // -1 strong cup .. 1 strong cap
  switch (colors) {
    case ShapeColors::kTable: {
      constexpr std::array<double, kShapes> kHue_deg{300, 275, 250, 205, 155, 115, 88, 62, 38};
      return srgb_from_lch(kFlatLightness + 22 * convexity, 8 + 62 * strength,
                           kHue_deg[static_cast<std::size_t>(shape)]);
    }
    case ShapeColors::kBlackWhite:
      break;
    case ShapeColors::kSkySun:
      return convexity < 0 ? srgb_from_lch(kFlatLightness + 38 * convexity, -52 * convexity, 265)
                           : srgb_from_lch(kFlatLightness + 27 * convexity, 62 * convexity, 72);
  }
  return srgb_from_lch(kFlatLightness + (convexity < 0 ? 55 : 38) * convexity, 0.0, 0.0);
}

std::array<ShapeRgb, 128> make_table(ShapeColors colors) {
  std::array<ShapeRgb, 128> table{};
  for (std::size_t id = 0; id < static_cast<std::size_t>(kShapeClasses); ++id)
    table[id] = color_of(colors, static_cast<std::uint8_t>(id));
  table[127] = table[0];
  return table;
}

}  // namespace

const std::array<ShapeRgb, 128>& shape_color_table(ShapeColors colors) {
  static const std::array<std::array<ShapeRgb, 128>, 3> kTables{
      make_table(ShapeColors::kTable), make_table(ShapeColors::kBlackWhite), make_table(ShapeColors::kSkySun)};
  return kTables[static_cast<std::size_t>(colors)];
}

std::vector<ShapeRgb> shape_vertex_colors(ShapeColors colors, std::span<const std::uint8_t> shape,
                                          std::span<const std::uint8_t> ao) {
  DUBSAR_CHECK(shape.empty() || ao.empty() || shape.size() == ao.size());
  const auto& table = shape_color_table(colors);
  std::vector<ShapeRgb> result(std::max(shape.size(), ao.size()));
  parallel_for(static_cast<std::int64_t>(result.size()), 1 << 16, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    const std::uint8_t id = shape.empty() ? std::uint8_t{0} : std::min(shape[v], std::uint8_t{127});
    result[v] = shade(table[id], ao.empty() ? std::uint8_t{63} : ao[v]);
  });
  return result;
}

}  // namespace dubsar
