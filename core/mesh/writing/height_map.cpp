#include "core/mesh/writing/height_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

namespace dubsar {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr double kSeam = 1e-9;  // of a triangle: what lies on an edge belongs to both

void fill(HeightMap& map, const std::array<glm::dvec3, 3>& p) {  // in steps; z in mm
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  if (!(area > 1e-12)) return;  // turned away, or edge on
  const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({p[0].x, p[1].x, p[2].x}))));
  const int x1 = std::min(map.width - 1, static_cast<int>(std::floor(std::max({p[0].x, p[1].x, p[2].x}))));
  const int y0 = std::max(0, static_cast<int>(std::ceil(std::min({p[0].y, p[1].y, p[2].y}))));
  const int y1 = std::min(map.height - 1, static_cast<int>(std::floor(std::max({p[0].y, p[1].y, p[2].y}))));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double a = ((p[1].x - x) * (p[2].y - y) - (p[2].x - x) * (p[1].y - y)) / area;
      const double b = ((p[2].x - x) * (p[0].y - y) - (p[0].x - x) * (p[2].y - y)) / area;
      const double c = 1.0 - a - b;
      if (a < -kSeam || b < -kSeam || c < -kSeam) continue;
      float& height = map.mm[map.index(x, y)];
      const auto found = static_cast<float>(a * p[0].z + b * p[1].z + c * p[2].z);
      if (std::isnan(height) || found > height) height = found;
    }
}

}  // namespace

HeightMap height_map(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles, const SideAxes& side,
                     double step_mm) {
  glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  std::vector<glm::dvec3> places(points_mm.size());  // along the axes of the side; a vertex is of six triangles
  for (std::size_t v = 0; v < places.size(); ++v) {
    const glm::dvec3& p = points_mm[v];
    places[v] = {glm::dot(p, side.right), glm::dot(p, side.up), glm::dot(p, side.front)};
  }
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) {
      low = glm::min(low, glm::dvec2(places[v]));
      high = glm::max(high, glm::dvec2(places[v]));
    }
  HeightMap map;
  map.step_mm = step_mm;
  if (triangles.empty() || !(step_mm > 0.0)) return map;
  map.width = static_cast<int>((high.x - low.x) / map.step_mm) + 1;
  map.height = static_cast<int>((high.y - low.y) / map.step_mm) + 1;
  map.mm.assign(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), kNothing);
  for (glm::dvec3& p : places) {
    p.x = (p.x - low.x) / map.step_mm;
    p.y = (p.y - low.y) / map.step_mm;
  }
  for (const Triangle& t : triangles) fill(map, {places[t[0]], places[t[1]], places[t[2]]});
  return map;
}

HeightMap halved(const HeightMap& map) {
  HeightMap out;
  out.width = map.width / 2;
  out.height = map.height / 2;
  out.step_mm = 2.0 * map.step_mm;
  out.mm.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), kNothing);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      double sum = 0.0;
      int known = 0;
      for (const auto& [dx, dy] : {std::array{0, 0}, {1, 0}, {0, 1}, {1, 1}})
        if (const float mm = map.at(2 * x + dx, 2 * y + dy); !std::isnan(mm)) {
          sum += static_cast<double>(mm);
          ++known;
        }
      if (known >= 3) out.mm[out.index(x, y)] = static_cast<float>(sum / known);
    }
  return out;
}

}  // namespace dubsar
