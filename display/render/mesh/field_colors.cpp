// Scales and colours of the figures of a surface.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "display/render/mesh/surface_field.h"

namespace dubsar {
namespace {

constexpr double kMostDistance = 0.12;                                 // deep wedges and their rims
constexpr double kMostMean = 2.0, kMostGaussian = 2.0, kMostBent = 3;  // 1/mm, 1/mm2: rims of wedges
constexpr double kMostDifference = 0.25;                               // mm, as of dubsar compare
constexpr double kDeepest = 0.06, kClay = 1.25;

/// From concave to convex; both ends are as dark, whatever colours one sees.
constexpr std::array<Rgb8, 7> kBlueOrange{
    {{33, 102, 172}, {103, 169, 207}, {209, 229, 240}, {247, 247, 247}, {254, 224, 182}, {241, 163, 64}, {179, 88, 6}}};
constexpr std::array<Rgb8, 10> kCividis{{{0, 32, 77},
                                         {0, 51, 111},
                                         {57, 72, 107},
                                         {87, 92, 109},
                                         {112, 113, 115},
                                         {138, 135, 121},
                                         {166, 157, 117},
                                         {196, 181, 108},
                                         {228, 207, 91},
                                         {255, 234, 70}}};
constexpr std::array<Rgb8, 2> kGrey{{{26, 26, 26}, {245, 245, 245}}};

Rgb8 between(std::span<const Rgb8> stops, double at) {
  const double place = std::clamp(at, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double part = place - static_cast<double>(low);
  Rgb8 out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(std::lround((1 - part) * stops[low][c] + part * stops[low + 1][c]));
  return out;
}

/// Clay: dark hollows, white ridges, bent towards both so that nothing becomes level.
Rgb8 clay(const Rgb8& base, double x) {
  const double brightest = std::max({base[0], base[1], base[2], std::uint8_t{1}});
  const double room = x < 0 ? 1.0 - kDeepest : std::max(255.0 / brightest - 1.0, 1e-6);
  const double factor = 1.0 + (x < 0 ? -1.0 : 1.0) * room * (1.0 - std::exp(-std::abs(kClay * 2.0 * x) / room));
  Rgb8 out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(std::lround(std::clamp(base[c] * factor, 0.0, 255.0)));
  return out;
}

}  // namespace

FieldScale field_scale(const Style& style) {
  FieldScale out;
  switch (style.map) {
    case ColorMap::kIntegral:
      out = {"integral invariants", "", -kMostDistance, kMostDistance};
      break;
    case ColorMap::kMean:
      out = {"mean curvature", "1/mm", -kMostMean, kMostMean};
      break;
    case ColorMap::kGaussian:
      out = {"Gaussian curvature", "1/mm\u00b2", -kMostGaussian, kMostGaussian};
      break;
    case ColorMap::kShapeIndex:
      out = {"shape index", "", -1.0, 1.0};
      break;
    case ColorMap::kCurvedness:
      out = {"curvedness", "1/mm", 0.0, kMostBent};
      break;
    case ColorMap::kDifference:
      out = {"difference", "mm", -kMostDifference, kMostDifference};
      break;
    default:
      break;
  }
  const double contrast = std::max(style.contrast, 1e-3);
  out.from /= contrast;
  out.to /= contrast;
  return out;
}

std::array<Rgb8, kShapeRows> field_colors(const Style& style) {
  std::array<Rgb8, kShapeRows> out{};
  FieldColors colors = style.field_colors;
  if (colors == FieldColors::kDesigned && style.map != ColorMap::kIntegral && style.map != ColorMap::kDifference)
    colors = style.map == ColorMap::kCurvedness ? FieldColors::kCividis : FieldColors::kBlueOrange;
  for (int i = 0; i < kShapeRows; ++i) {
    const double at = i / (kShapeRows - 1.0);
    Rgb8& color = out[static_cast<std::size_t>(i)];
    switch (colors) {
      case FieldColors::kDesigned:
        color = style.map == ColorMap::kDifference ? difference_color(2.0 * at - 1.0, 1.0)
                                                   : clay(style.base_color, 2.0 * at - 1.0);
        break;
      case FieldColors::kBlueOrange:
        color = between(kBlueOrange, at);
        break;
      case FieldColors::kCividis:
        color = between(kCividis, at);
        break;
      case FieldColors::kGrey:
        color = between(kGrey, at);
        break;
    }
  }
  return out;
}

Rgb8 field_color(const Style& style, double figure) {
  if (std::isnan(figure)) return difference_color(figure, 1.0);
  const FieldScale scale = field_scale(style);
  const auto colors = field_colors(style);
  return between(colors, (figure - scale.from) / (scale.to - scale.from));
}

}  // namespace dubsar
