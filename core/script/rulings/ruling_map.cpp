#include "core/script/rulings/ruling_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/base/numbers/median.h"
#include "core/script/correction/wedge_edits.h"

namespace dubsar {
namespace {

constexpr float kRuledUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kRuledSlope = 1.2;  // rise over run: steeper is an edge, or a wedge's wall

/// What a wedge covers, a quarter of its width beyond it (wedge_at()).
void forget_wedge(RuledSide& side, const ScriptWedge& w) {
  const double reach = 0.5 * w.width_mm;
  glm::dvec2 low(1e30), high(-1e30);
  for (const glm::dvec3& p : {w.corner_mm[0], w.corner_mm[1], w.tail_mm}) {
    const glm::dvec2 q(glm::dot(p, side.axes.right), glm::dot(p, side.axes.up));
    low = {std::min(low.x, q.x), std::min(low.y, q.y)};
    high = {std::max(high.x, q.x), std::max(high.y, q.y)};
  }
  HeightMap& map = side.map;
  const auto cell = [&](const glm::dvec2& q) { return (q - side.low) / map.step_mm; };
  const glm::dvec2 from = cell(low - reach), to = cell(high + reach);
  for (int y = std::max(0, static_cast<int>(from.y)); y <= std::min(map.height - 1, static_cast<int>(to.y)); ++y)
    for (int x = std::max(0, static_cast<int>(from.x)); x <= std::min(map.width - 1, static_cast<int>(to.x)); ++x) {
      const float z = map.at(x, y);
      if (std::isnan(z)) continue;
      const glm::dvec3 place = (side.low.x + x * map.step_mm) * side.axes.right +
                               (side.low.y + y * map.step_mm) * side.axes.up + static_cast<double>(z) * side.axes.front;
      if (wedge_at({&w, 1}, place)) map.mm[map.index(x, y)] = kRuledUnknown;
    }
}

void forget_steep(HeightMap& map) {
  const HeightMap whole = map;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      bool level = x > 0 && y > 0 && x + 1 < map.width && y + 1 < map.height;
      if (level) {
        const double across = 0.5 * static_cast<double>(whole.at(x + 1, y) - whole.at(x - 1, y)) / map.step_mm,
                     up = 0.5 * static_cast<double>(whole.at(x, y + 1) - whole.at(x, y - 1)) / map.step_mm;
        level = std::hypot(across, up) < kRuledSlope;  // false where one of them is unknown
      }
      if (!level) map.mm[map.index(x, y)] = kRuledUnknown;
    }
}

}  // namespace

RuledSide ruled_side(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles, const TextSides& sides,
                     TextSide side, std::span<const ScriptWedge> wedges, double step_mm) {
  RuledSide out;
  out.axes = {sides.right_of(side), sides.up_of(side), sides.normal_of(side)};
  out.low = glm::dvec2(1e30);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t)
      out.low = {std::min(out.low.x, glm::dot(points_mm[v], out.axes.right)),
                 std::min(out.low.y, glm::dot(points_mm[v], out.axes.up))};
  out.map = height_map(points_mm, triangles, out.axes, step_mm);
  for (const ScriptWedge& w : wedges)
    if (w.side == side) forget_wedge(out, w);
  forget_steep(out.map);
  return out;
}

RulingMap ruling_map(const RuledSide& side, double reach_mm, double clip_mm) {
  const HeightMap& map = side.map;
  const int wide = std::max(1, static_cast<int>(std::lround(side.column_mm / map.step_mm))),
            off = std::max(1, static_cast<int>(std::lround(reach_mm / map.step_mm)));
  RulingMap out;
  out.columns = map.width / wide;
  out.rows = map.height;
  out.mm.assign(static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows), kRuledUnknown);
  std::vector<double> all;
  for (int y = off; y + off < map.height; ++y)
    for (int c = 0; c < out.columns; ++c) {
      double sum = 0.0;
      int known = 0;
      for (int x = c * wide; x < (c + 1) * wide; ++x) {
        const double low =
            static_cast<double>(map.at(x, y)) - 0.5 * static_cast<double>(map.at(x, y - off) + map.at(x, y + off));
        if (std::isnan(low)) continue;
        sum += std::clamp(low, -clip_mm, clip_mm);
        ++known;
      }
      if (2 * known < wide) continue;
      out.mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(out.columns) + static_cast<std::size_t>(c)] =
          static_cast<float>(sum / known);
      all.push_back(sum / known);
    }
  if (all.empty()) return out;
  const double level = median(all);
  for (double& v : all) v = std::abs(v - level);
  out.deviation_mm = 1.4826 * median(all);
  for (float& v : out.mm) v -= static_cast<float>(level);
  return out;
}

}  // namespace dubsar
