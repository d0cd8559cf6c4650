#include "core/script/marks/find_cracks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/mesh/writing/height_map.h"
#include "core/mesh/writing/measured_places.h"

namespace dubsar {
namespace {

// mm. Walls of a stylus's valleys rise less than twice their breadth from the middle, those of a crack more.
constexpr double kCrackWidths[] = {0.5, 1.0};               // narrower than it, and deeper
constexpr double kCrackDeeper = 1.1;                        // than that width
constexpr double kCrackShortest = 4.0, kCrackLonger = 4.0;  // times as long as wide
constexpr double kCrackSlope = 1.2;                         // of the clay around: steeper is another side's
constexpr double kCrackPointEvery = 0.5;
constexpr float kCrackHole = -1e6f;  // mm: nothing is seen

/// Greatest (`up`) or least of squares of (2 reach + 1)^2 cells.
std::vector<float> extremes(const std::vector<float>& in, int width, int height, int reach, bool up) {
  std::vector<float> across(in.size()), out(in.size());
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  const auto better = [&](float a, float b) { return up ? std::max(a, b) : std::min(a, b); };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float best = in[at(x, y)];
      for (int k = std::max(0, x - reach); k <= std::min(width - 1, x + reach); ++k) best = better(best, in[at(k, y)]);
      across[at(x, y)] = best;
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float best = across[at(x, y)];
      for (int k = std::max(0, y - reach); k <= std::min(height - 1, y + reach); ++k)
        best = better(best, across[at(x, k)]);
      out[at(x, y)] = best;
    }
  return out;
}

/// A side with a border of holes; `closed`: gaps narrower than the width are filled.
struct CrackSide {
  SideAxes axes;
  glm::dvec2 low{0.0};
  HeightMap map;
  std::vector<float> closed;
  double width_mm = 0.0;
  glm::dvec3 place(std::size_t at) const {
    const auto w = static_cast<std::size_t>(map.width);
    const glm::dvec2 p = low + map.step_mm * glm::dvec2(at % w, at / w);
    return p.x * axes.right + p.y * axes.up + static_cast<double>(closed[at]) * axes.front;
  }
};

/// Adds to `gaps` what is narrower than the side's width and deeper, on clay that faces the side.
void add_narrow_gaps(const CrackSide& side, std::vector<char>& gaps) {
  const HeightMap& map = side.map;
  const int off = std::max(2, static_cast<int>(std::lround(side.width_mm / map.step_mm)));
  for (int y = off; y + off < map.height; ++y)
    for (int x = off; x + off < map.width; ++x) {
      const std::size_t at = map.index(x, y);
      if (static_cast<double>(side.closed[at] - map.mm[at]) < kCrackDeeper * side.width_mm) continue;
      const auto slope = [&](std::size_t a, std::size_t b) {
        return static_cast<double>(side.closed[a] - side.closed[b]) / (2.0 * off * map.step_mm);
      };
      if (std::hypot(slope(map.index(x + off, y), map.index(x - off, y)),
                     slope(map.index(x, y + off), map.index(x, y - off))) < kCrackSlope)
        gaps[at] = 1;
    }
}

/// Steps from `first` through the mask, and where each place was come to from; the last one that was reached.
std::size_t walk(const std::vector<char>& mask, int width, std::size_t first, std::vector<std::size_t>& from,
                 std::vector<std::size_t>& order) {
  constexpr auto kNew = std::numeric_limits<std::size_t>::max();
  for (const std::size_t at : order) from[at] = kNew;
  order.assign(1, first);
  from[first] = first;
  for (std::size_t k = 0; k < order.size(); ++k)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const std::size_t next = order[k] + static_cast<std::size_t>(dy * width + dx);  // the border is never covered
        if (next >= mask.size() || !mask[next] || from[next] != kNew) continue;
        from[next] = order[k];
        order.push_back(next);
      }
  return order.back();
}

std::vector<ScriptCrack> cracks_of(const CrackSide& side, const std::vector<char>& gaps, TextSide which) {
  std::vector<ScriptCrack> out;
  const HeightMap& map = side.map;
  std::vector<char> mask(gaps.size(), 0);  // with a cell around: pieces that nearly touch are one
  for (int y = 1; y + 1 < map.height; ++y)
    for (int x = 1; x + 1 < map.width; ++x)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (gaps[map.index(x + dx, y + dy)]) mask[map.index(x, y)] = 1;
  std::vector<std::size_t> from(mask.size(), std::numeric_limits<std::size_t>::max()), order;
  for (std::size_t first = 0; first < mask.size(); ++first) {
    if (!mask[first]) continue;
    const std::size_t end = walk(mask, map.width, first, from, order), begin = walk(mask, map.width, end, from, order);
    std::vector<glm::dvec3> line;
    double length = 0.0;
    for (std::size_t at = begin;; at = from[at]) {
      line.push_back(side.place(at));
      if (line.size() > 1)
        length += glm::length(glm::dvec2(glm::dot(line.back() - line[line.size() - 2], side.axes.right),
                                         glm::dot(line.back() - line[line.size() - 2], side.axes.up)));
      if (at == from[at]) break;
    }
    std::size_t area = 0;
    for (const std::size_t at : order) {
      area += gaps[at] ? 1 : 0;
      mask[at] = 0;
      from[at] = std::numeric_limits<std::size_t>::max();
    }
    order.clear();
    const double width = static_cast<double>(area) * map.step_mm * map.step_mm / std::max(length, 1e-9);
    if (length < kCrackShortest || length < kCrackLonger * width) continue;
    ScriptCrack crack;
    crack.side = which;
    crack.width_mm = width;
    const auto step = static_cast<std::size_t>(std::max(1L, std::lround(kCrackPointEvery / map.step_mm)));
    for (std::size_t k = 0; k < line.size(); k += step) {
      const std::size_t a = k < step ? 0 : k - step, b = std::min(line.size(), k + step + 1);
      glm::dvec3 sum(0.0);
      for (std::size_t j = a; j < b; ++j) sum += line[j];
      crack.line_mm.push_back(sum / static_cast<double>(b - a));
    }
    out.push_back(std::move(crack));
  }
  return out;
}

CrackSide crack_side(std::span<const glm::dvec3> points, std::span<const Triangle> triangles, const TextSides& sides,
                     TextSide which, double step_mm) {
  CrackSide out;
  out.axes = {sides.right_of(which), sides.up_of(which), sides.normal_of(which)};
  out.low = glm::dvec2(1e30);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t)
      out.low = glm::min(out.low, glm::dvec2(glm::dot(points[v], out.axes.right), glm::dot(points[v], out.axes.up)));
  out.map = height_map(points, triangles, out.axes, step_mm);
  for (float& v : out.map.mm)
    if (std::isnan(v)) v = kCrackHole;
  return out;
}

}  // namespace

std::vector<ScriptCrack> find_cracks(const TriMesh& mesh, const TextSides& sides) {
  const std::vector<glm::dvec3> points = places_mm(mesh);
  std::vector<ScriptCrack> out;
  for (std::size_t s = 0; s < kTextSideCount && !mesh.triangles.empty(); ++s) {
    const auto which = static_cast<TextSide>(s);
    CrackSide side = crack_side(points, mesh.triangles, sides, which, 0.1);
    std::vector<char> gaps(side.map.mm.size(), 0);
    for (const double width : kCrackWidths) {
      side.width_mm = width;
      const int reach = std::max(1, static_cast<int>(std::lround(0.5 * width / side.map.step_mm)));
      side.closed = extremes(extremes(side.map.mm, side.map.width, side.map.height, reach, true), side.map.width,
                             side.map.height, reach, false);
      add_narrow_gaps(side, gaps);
    }
    for (ScriptCrack& crack : cracks_of(side, gaps, which)) out.push_back(std::move(crack));
  }
  return out;
}

}  // namespace dubsar
