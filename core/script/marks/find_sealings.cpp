#include "core/script/marks/find_sealings.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/base/numbers/median.h"
#include "core/mesh/writing/measured_places.h"
#include "core/script/copy_mask.h"
#include "core/script/marks/side_raster.h"
#include "core/script/rulings/ruling_map.h"

namespace dubsar {
namespace {

// mm. Limbs and bodies of figures are 1 to 4 broad and stand out by .2 to 1, of which a scan keeps a half; seals are 10
// to 40 high. Bounds were set on phantoms' envelopes (931001 to 931003).
constexpr double kSealStep = 0.2, kSealFigure = 4.0, kSealReach = 3.0;
constexpr double kSealLeastRelief = 0.07, kSealNoises = 4.0;  // of each place of a figure
constexpr double kSealRelief = 0.11;                          // of all of a sealing, in the median
constexpr double kSealLeastFigure = 0.8, kSealApart = 6.0;    // half of what is empty between figures
constexpr double kSealMostFigures = 0.45;         // of the places: a seal's are .1 to .3, what pits leave .8
constexpr double kSealPit = 0.4, kSealRim = 1.5;  // of the usual depth of wedges: deeper is one; around it
constexpr double kSealBroad = 8.0, kSealArea = 150.0, kSealTolerance = 0.4;

/// Squares of (2 reach + 1)^2 cells that are all covered, or (`any`) of which one is.
std::vector<char> of_squares(const std::vector<char>& mask, int width, int height, int reach, bool any) {
  std::vector<float> values(mask.begin(), mask.end());
  const std::vector<float> means = square_means(values, width, height, reach, 0.0);
  std::vector<char> out(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) out[i] = any ? means[i] > 1e-6f : means[i] > 1.0f - 1e-6f;
  return out;
}

/// Numbers of connected areas from 1, 0 outside; returns the number of places of each.
std::vector<std::size_t> number_areas(const std::vector<char>& mask, int width, std::vector<int>& numbers) {
  std::vector<std::size_t> sizes{0}, open;
  numbers.assign(mask.size(), 0);
  const auto w = static_cast<std::size_t>(width);
  for (std::size_t first = 0; first < mask.size(); ++first) {
    if (!mask[first] || numbers[first] != 0) continue;
    const int number = static_cast<int>(sizes.size());
    sizes.push_back(0);
    open.assign(1, first);
    numbers[first] = number;
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      ++sizes.back();
      const auto visit = [&](std::size_t next) {
        if (mask[next] && numbers[next] == 0) numbers[next] = number, open.push_back(next);
      };
      if (at % w > 0) visit(at - 1);
      if (at % w + 1 < w) visit(at + 1);
      if (at >= w) visit(at - w);
      if (at + w < mask.size()) visit(at + w);
    }
  }
  return sizes;
}

/// A place of the side's plane on the surface: the nearest known height along its row.
glm::dvec3 lifted(const RuledSide& side, const glm::dvec2& at) {
  const HeightMap& map = side.map;
  const int x = std::clamp(static_cast<int>(std::lround((at.x - side.low.x) / map.step_mm)), 0, map.width - 1),
            y = std::clamp(static_cast<int>(std::lround((at.y - side.low.y) / map.step_mm)), 0, map.height - 1);
  double height = 0.0;
  for (int off = 0; off < map.width; ++off) {
    const int i = x - off >= 0 && !std::isnan(map.at(x - off, y)) ? x - off : x + off;
    if (i < 0 || i >= map.width || std::isnan(map.at(i, y))) continue;
    height = static_cast<double>(map.at(i, y));
    break;
  }
  return at.x * side.axes.right + at.y * side.axes.up + height * side.axes.front;
}

std::vector<char> without_specks(const std::vector<char>& mask, int width, int least) {
  std::vector<int> numbers;
  const std::vector<std::size_t> sizes = number_areas(mask, width, numbers);
  std::vector<char> out(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i)
    out[i] = mask[i] && sizes[static_cast<std::size_t>(numbers[i])] >= static_cast<std::size_t>(least);
  return out;
}

/// Makes unknown what lies deeper than `pit_mm` below what a paraboloid touches from above: wedges that were not found,
/// whose rims would stand out.
void forget_pits(HeightMap& map, double pit_mm) {
  HeightMap turned = map;
  for (float& v : turned.mm) v = -v;
  const std::vector<float> deep = stands_out(turned, kSealFigure, kSealReach);
  std::vector<char> pits(deep.size());
  for (std::size_t i = 0; i < deep.size(); ++i) pits[i] = static_cast<double>(deep[i]) > pit_mm;
  pits =
      of_squares(pits, map.width, map.height, std::max(1, static_cast<int>(std::lround(kSealRim / map.step_mm))), true);
  for (std::size_t i = 0; i < pits.size(); ++i)
    if (pits[i]) map.mm[i] = std::numeric_limits<float>::quiet_NaN();
}

std::vector<ScriptSealing> sealings_of(const RuledSide& side, TextSide which, double pit_mm) {
  std::vector<ScriptSealing> out;
  const HeightMap& map = side.map;
  if (map.width < 3 || map.height < 3) return out;
  const auto cells = [&](double mm) { return std::max(1, static_cast<int>(std::lround(mm / map.step_mm))); };
  HeightMap even = map;
  even.mm = square_means(map.mm, map.width, map.height, 1, 0.5);
  std::vector<double> noises;
  for (std::size_t i = 0; i < map.mm.size(); ++i)
    if (const auto d = static_cast<double>(map.mm[i] - even.mm[i]); !std::isnan(d)) noises.push_back(std::abs(d));
  if (noises.empty()) return out;
  const auto least = static_cast<float>(std::max(kSealLeastRelief, kSealNoises * 1.4826 * median(noises)));
  forget_pits(even, pit_mm);
  const std::vector<float> relief = stands_out(even, kSealFigure, kSealReach);
  std::vector<char> figures(relief.size());
  for (std::size_t i = 0; i < relief.size(); ++i) figures[i] = relief[i] > least;
  figures = without_specks(figures, map.width, cells(kSealLeastFigure) * cells(kSealLeastFigure));
  // Closed over what lies between figures, then without what is narrower than a seal.
  const int apart = cells(kSealApart), broad = cells(0.5 * kSealBroad);
  std::vector<char> mask =
      of_squares(of_squares(figures, map.width, map.height, apart, true), map.width, map.height, apart, false);
  mask = of_squares(of_squares(mask, map.width, map.height, broad, false), map.width, map.height, broad, true);
  std::vector<int> numbers;
  const std::vector<std::size_t> sizes = number_areas(mask, map.width, numbers);
  for (int number = 1; number < static_cast<int>(sizes.size()); ++number) {
    const auto area = static_cast<double>(sizes[static_cast<std::size_t>(number)]) * map.step_mm * map.step_mm;
    if (area < kSealArea) continue;
    CopyMask drawn(side.low, side.low + map.step_mm * glm::dvec2(map.width, map.height), map.step_mm);
    std::vector<double> heights;
    double known = 0.0;
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const std::size_t at = map.index(x, y);
        if (numbers[at] != number) continue;
        const glm::dvec2 p = side.low + map.step_mm * (glm::dvec2(x, y) + 0.5);  // inside of a cell
        drawn.add_triangle(p, p, p);
        if (!std::isnan(relief[at])) known += 1.0;
        if (relief[at] > least) heights.push_back(static_cast<double>(relief[at]));
      }
    if (static_cast<double>(heights.size()) > kSealMostFigures * known || median(heights) < kSealRelief) continue;
    ScriptSealing sealing;
    sealing.side = which;
    sealing.relief_mm = median(heights);
    const auto outlines = drawn.outlines(kSealTolerance, 8);  // those inside of the first are holes
    for (const glm::dvec2& p : outlines.front()) sealing.outline_mm.push_back(lifted(side, p - 0.5 * map.step_mm));
    out.push_back(std::move(sealing));
  }
  return out;
}

}  // namespace

std::vector<ScriptSealing> find_sealings(const TriMesh& mesh, const TextSides& sides,
                                         std::span<const ScriptWedge> wedges) {
  const std::vector<glm::dvec3> points = places_mm(mesh);
  const std::vector<Triangle> triangles = measured_triangles(mesh);
  std::vector<ScriptSealing> out;
  if (triangles.empty()) return out;
  std::vector<double> depths;
  for (const ScriptWedge& w : wedges) depths.push_back(w.depth_mm);
  const double pit = depths.empty() ? 1e9 : kSealPit * median(depths);
  for (std::size_t s = 0; s < kTextSideCount; ++s) {
    const auto which = static_cast<TextSide>(s);
    const RuledSide side = ruled_side(points, triangles, sides, which, wedges, kSealStep);
    for (ScriptSealing& sealing : sealings_of(side, which, pit)) out.push_back(std::move(sealing));
  }
  return out;
}

}  // namespace dubsar
