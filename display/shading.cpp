#include "display/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace dubsar {
namespace {

Rgb8 shape_color(ColorMap map, int id) {
  if (id == 0) return {128, 128, 128};
  const double s = ((id - 1) % 9 - 4) / 4.0, w = ((id - 1) / 9 + 1) / 14.0;
  const double v = s * w;
  if (map == ColorMap::kBlackWhite) {
    const auto g = static_cast<std::uint8_t>(std::lround(128 + 127 * v));
    return {g, g, g};
  }
  return {static_cast<std::uint8_t>(std::lround(128 + 127 * v)), 128, static_cast<std::uint8_t>(std::lround(128 - 127 * v))};
}

struct Preset {
  std::string_view name;
  ColorMap map;
  bool ambient_occlusion, lit;
};
constexpr std::array<Preset, 9> kPresets{{{"relief", ColorMap::kBlackWhite, true, true},
                                          {"phong", ColorMap::kPlain, false, true},
                                          {"table", ColorMap::kTable, false, false},
                                          {"black-white", ColorMap::kBlackWhite, false, false},
                                          {"sky-sun", ColorMap::kSkySun, false, false},
                                          {"ao", ColorMap::kPlain, true, false},
                                          {"table-ao", ColorMap::kTable, true, false},
                                          {"black-white-ao", ColorMap::kBlackWhite, true, false},
                                          {"sky-sun-ao", ColorMap::kSkySun, true, false}}};

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
      shading.map = preset.map;
      shading.ambient_occlusion = preset.ambient_occlusion;
      shading.lit = preset.lit;
      return shading;
    }
    known += known.empty() ? "" : ", ";
    known += preset.name;
  }
  return fail(ErrorKind::kUsage, "shading \"{}\" is not known, expected one of: {}", name, known);
}

std::array<Rgb8, 8> distinct_partition_colors() {
  // Paul Tol's bright scheme and two more, ordered so that neighbours differ in lightness.
  return {Rgb8{240, 228, 66}, {68, 119, 170}, {230, 159, 0}, {34, 136, 51}, {204, 187, 68}, {170, 51, 119}, {187, 187, 187}, {102, 204, 238}};
}

std::vector<std::array<std::uint8_t, 4>> color_table(const Shading& shading) {
  std::vector<std::array<std::uint8_t, 4>> table;
  table.reserve(kShapeRows * kAoColumns);
  for (int ao = 0; ao < kAoColumns; ++ao)
    for (int shape = 0; shape < kShapeRows; ++shape) {
      const double light = shading.ambient_occlusion ? ao / 63.0 : 1.0;
      std::array<std::uint8_t, 4> entry{0, 0, 0, 255};
      const Rgb8 mapped = shading.map == ColorMap::kPlain ? shading.base_color : shape_color(shading.map, shape);
      for (int c = 0; c < 3; ++c) entry[c] = static_cast<std::uint8_t>(std::lround(mapped[c] * light));
      table.push_back(entry);
    }
  return table;
}

glm::dvec3 light_direction(const Shading& shading) {
  const double azimuth = shading.light_azimuth_deg * std::numbers::pi / 180;
  const double elevation = shading.light_elevation_deg * std::numbers::pi / 180;
  return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
}

}  // namespace dubsar
