#include "display/render/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/base/text/near_word.h"
#include "core/relief/curvature/shape_colors.h"
#include "display/render/mesh/surface_field.h"

namespace dubsar {
namespace {

ShapeColors shape_colors_of(ColorMap map) {
  switch (map) {
    case ColorMap::kTable:
      return ShapeColors::kTable;
    case ColorMap::kSkySun:
      return ShapeColors::kSkySun;
    default:
      break;
  }
  return ShapeColors::kBlackWhite;
}

constexpr double kDeepest = 0.06;  // of the base colour's bytes, for the strongest cup at any contrast

struct Preset {
  std::string_view name;
  ColorMap map;
  bool ambient_occlusion, lit;
  bool rakes = false;
};
constexpr std::array<Preset, 17> kPresets{{{"relief", ColorMap::kBlackWhite, true, true},
                                           {"phong", ColorMap::kPlain, false, true},
                                           {"raking", ColorMap::kPlain, false, true, true},
                                           {"table", ColorMap::kTable, false, false},
                                           {"black-white", ColorMap::kBlackWhite, false, false},
                                           {"sky-sun", ColorMap::kSkySun, false, false},
                                           {"ao", ColorMap::kPlain, true, false},
                                           {"table-ao", ColorMap::kTable, true, false},
                                           {"black-white-ao", ColorMap::kBlackWhite, true, false},
                                           {"sky-sun-ao", ColorMap::kSkySun, true, false},
                                           {"msii", ColorMap::kIntegral, false, false},
                                           {"radiance", ColorMap::kPlain, false, true},
                                           {"mean-curvature", ColorMap::kMean, false, false},
                                           {"gaussian-curvature", ColorMap::kGaussian, false, false},
                                           {"shape-index", ColorMap::kShapeIndex, false, false},
                                           {"curvedness", ColorMap::kCurvedness, false, false},
                                           {"photograph", ColorMap::kPlain, false, false}}};

/// A lamp beside the tablet in a dark room. Level clay is a middle grey; walls towards the lamp come close to white.
Light raking_light() {
  Light light;
  light.elevation_deg = 15;
  light.ambient = 0.02;
  light.key = 0.42;
  light.fill = 0.02;  // so that walls in the shadow keep their slopes
  light.specular = 0.0;
  light.even = true;
  light.shadows = true;
  light.knee = 0.6;
  return light;
}

/// 1 + x where x is small; towards `least` (below 1) and `most` (above 1) where it is not. Slope 1 at 0, never level.
double bent(double x, double least, double most) {
  const double room = x < 0 ? 1.0 - least : std::max(most - 1.0, 1e-6);
  return x < 0 ? 1.0 - room * (1.0 - std::exp(x / room)) : 1.0 + room * (1.0 - std::exp(-x / room));
}

}  // namespace

std::vector<std::string_view> shading_preset_names() {
  std::vector<std::string_view> names;
  for (const Preset& preset : kPresets) names.push_back(preset.name);
  return names;
}

Result<Shading> shading_preset(std::string_view name) {
  std::string known;
  for (const Preset& preset : kPresets) {
    if (preset.name == name) {
      Shading shading;
      Style& style = shading.style;
      style.map = preset.map;
      style.ambient_occlusion = preset.ambient_occlusion;
      style.lit = preset.lit;
      if (name == "radiance") style.radiance = 1.0;
      if (is_field(preset.map)) {
        style.contrast = style.occlusion_power = 1.0;
      } else if (!preset.lit) {  // figure 14: the table's own colours; ambient light alone is white
        style.base_color =
            preset.map == ColorMap::kPlain ? Rgb8{255, 255, 255} : shape_color_table(shape_colors_of(preset.map))[0];
        style.contrast = 1.0;
        style.occlusion_power = 1.0;
        style.shoulder = false;
      }
      if (preset.rakes) shading.light = raking_light();
      return shading;
    }
    known += known.empty() ? "" : ", ";
    known += preset.name;
  }
  return fail(ErrorKind::kUsage, "shading \"{}\" is not known, expected one of: {}{}", name, known,
              did_you_mean(name, known));
}

std::array<Rgb8, 8> distinct_partition_colors() {
  // Paul Tol's bright scheme and two more, ordered so that neighbours differ in lightness.
  return {Rgb8{240, 228, 66}, {68, 119, 170}, {230, 159, 0},   {34, 136, 51},
          {204, 187, 68},     {170, 51, 119}, {187, 187, 187}, {102, 204, 238}};
}

std::uint8_t visible_partitions(const PartLooks& parts) {
  unsigned bits = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) bits |= parts[p].visible ? 1u << p : 0u;
  return static_cast<std::uint8_t>(bits);
}

void show_partitions(PartLooks& parts, std::uint8_t bits) {
  for (std::size_t p = 0; p < parts.size(); ++p) parts[p].visible = (bits >> p & 1) != 0;
}

void color_partitions(PartLooks& parts, const std::array<Rgb8, 8>& colors) {
  for (std::size_t p = 0; p < parts.size(); ++p) parts[p].color = colors[p];
}

std::vector<std::array<std::uint8_t, 4>> color_table(const Style& style) {
  if (is_field(style.map)) {
    const auto colors = field_colors(style);
    std::vector<std::array<std::uint8_t, 4>> table;
    for (int ao = 0; ao < kAoColumns; ++ao)
      for (const Rgb8& own : colors) {
        const double open = std::pow(ao / (kAoColumns - 1.0), style.occlusion_power) * (kAoColumns - 1);
        const Rgb8 c = style.ambient_occlusion ? shade(own, static_cast<std::uint8_t>(std::lround(open))) : own;
        table.push_back({c[0], c[1], c[2], 255});
      }
    return table;
  }
  const auto& shapes = shape_color_table(shape_colors_of(style.map));
  const double contrast = style.map == ColorMap::kPlain ? 0.0 : style.contrast;
  std::vector<std::array<std::uint8_t, 4>> table;
  table.reserve(kShapeRows * kAoColumns);
  const double brightest = std::max({style.base_color[0], style.base_color[1], style.base_color[2], std::uint8_t{1}});
  const auto factor = [&](double x) {
    return style.shoulder ? bent(x, kDeepest, 255.0 / brightest) : std::max(1.0 + x, 0.0);
  };
  for (int ao = 0; ao < kAoColumns; ++ao) {
    const double open = std::pow(ao / (kAoColumns - 1.0), style.occlusion_power) * (kAoColumns - 1);
    for (const ShapeRgb& shape : shapes) {
      std::array<double, 3> value{};
      for (std::size_t c = 0; c < 3; ++c)
        value[c] = style.base_color[c] * factor(contrast * (shape[c] - shapes[0][c]) / shapes[0][c]);
      // Too bright: darker rather than of another hue.
      const double fit = std::min(1.0, 255.0 / std::max({value[0], value[1], value[2], 1.0}));
      Rgb8 color{};
      for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<std::uint8_t>(std::lround(fit * value[c]));
      if (style.ambient_occlusion) color = shade(color, static_cast<std::uint8_t>(std::lround(open)));
      table.push_back({color[0], color[1], color[2], 255});
    }
  }
  return table;
}

glm::dvec3 light_direction(const Light& light) {
  const double azimuth = light.azimuth_deg * std::numbers::pi / 180;
  const double elevation = light.elevation_deg * std::numbers::pi / 180;
  return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
}

}  // namespace dubsar
