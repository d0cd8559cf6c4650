#include "core/script/rulings/find_rulings.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "core/base/numbers/median.h"
#include "core/mesh/writing/measured_places.h"
#include "core/script/rulings/ruling_map.h"

namespace dubsar {
namespace {

// mm and degrees. Hands rule nearly straight; a tenth of a mm is as shallow as a line that one sees may be.
constexpr double kRuleClimb = 3.0, kRuleClimbStep = 0.3, kRuleBend = 0.0009, kRuleBendStep = 0.0003;
constexpr double kRuleShortest = 8.0, kRuleHeads = 5.0, kRuleApart = 0.9, kRuleLeastDepth = 0.03;
constexpr double kRuleClip = 0.3, kRulePointEvery = 2.0;
constexpr double kRuleReaches[] = {0.45, 0.7, 1.0};  // of the clay beside a ruling, or 1.5 edges of the mesh and more
constexpr double kRuleClear = 9.0;                   // deviations of the mean
constexpr double kRuleSeen = 0.7, kRuleKnown = 0.35;

/// Rows of the map by the way along the columns from the middle one.
struct RulePath {
  double row = 0.0, slope = 0.0, bend = 0.0;  // slope: rows a column, bend: rows a column squared
  double at(double column) const { return row + (slope + bend * column) * column; }
};

struct RuleScore {
  double mean = 0.0, clear = 0.0;
  int known = 0;
};

std::optional<float> value_on(const RulingMap& map, const RulePath& path, int column) {
  const int row = static_cast<int>(std::lround(path.at(column - 0.5 * map.columns)));
  if (row < 0 || row >= map.rows || std::isnan(map.at(column, row))) return std::nullopt;
  return map.at(column, row);
}

RuleScore score(const RulingMap& map, const RulePath& path) {
  RuleScore out;
  double sum = 0.0;
  for (int c = 0; c < map.columns; ++c)
    if (const auto v = value_on(map, path, c)) {
      sum += static_cast<double>(*v);
      ++out.known;
    }
  if (out.known == 0 || !(map.deviation_mm > 0.0)) return out;
  out.mean = sum / out.known;
  out.clear = -out.mean * std::sqrt(static_cast<double>(out.known)) / map.deviation_mm;
  return out;
}

/// A line of a map: its path and from where to where it is seen, in columns.
struct SeenRule {
  RulePath path;
  double from = 0.0, to = 0.0, depth_mm = 0.0, clear = 0.0;
};

/// The stretch on which it is lower than half of its depth, most clearly; ends where it crosses that half.
std::optional<SeenRule> seen_stretch(const RulingMap& map, const RulePath& path, double column_mm, double shortest_mm) {
  std::vector<std::optional<double>> values(static_cast<std::size_t>(map.columns));
  for (int c = 0; c < map.columns; ++c) {  // means of three: no end is sharper than the scan
    double sum = 0.0;
    int known = 0;
    for (int k = std::max(0, c - 1); k <= std::min(map.columns - 1, c + 1); ++k)
      if (const auto v = value_on(map, path, k)) sum -= static_cast<double>(*v), ++known;
    if (known >= 2) values[static_cast<std::size_t>(c)] = sum / known;
  }
  std::vector<double> all;
  for (const auto& v : values)
    if (v) all.push_back(*v);
  if (all.size() < 4) return std::nullopt;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() * 2 / 3), all.end());
  double depth = all[all.size() * 2 / 3];
  std::size_t from = 0, to = 0;
  for (int round = 0; round < 4; ++round) {
    if (!(depth > kRuleLeastDepth)) return std::nullopt;
    double best = 0.0, sum = 0.0;
    std::size_t begin = 0;
    from = to = 0;
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (values[c]) sum += *values[c] - 0.5 * depth;
      if (sum <= 0.0) sum = 0.0, begin = c + 1;
      if (sum > best) best = sum, from = begin, to = c;
    }
    std::vector<double> inside;
    for (std::size_t c = from; c <= to; ++c)
      if (values[c]) inside.push_back(*values[c]);
    if (inside.empty()) return std::nullopt;
    depth = median(inside);
  }
  SeenRule out{path, static_cast<double>(from), static_cast<double>(to) + 1.0, depth, 0.0};
  const auto crossing = [&](std::size_t in, std::ptrdiff_t step) {  // where between two columns it is half as deep
    const auto next = static_cast<std::ptrdiff_t>(in) + step;
    if (next < 0 || next >= map.columns || !values[in] || !values[static_cast<std::size_t>(next)]) return 0.0;
    const double a = *values[in], b = *values[static_cast<std::size_t>(next)];
    return a > 0.5 * depth && b < 0.5 * depth ? std::clamp((a - 0.5 * depth) / (a - b), 0.0, 1.0) - 0.5 : 0.0;
  };
  out.from -= crossing(from, -1);
  out.to += crossing(to, 1);
  int known = 0, seen = 0;
  double sum = 0.0;
  for (std::size_t c = from; c <= to; ++c) {
    const auto here = value_on(map, path, static_cast<int>(c));  // by itself: rows of pits have level clay between
    if (!here) continue;
    ++known;
    seen += -static_cast<double>(*here) > depth / 3.0 ? 1 : 0;
    sum -= static_cast<double>(*here);
  }
  const auto columns = static_cast<double>(to - from + 1);
  if (columns * column_mm < shortest_mm || known < kRuleKnown * columns || seen < kRuleSeen * known)
    return std::nullopt;
  out.clear = sum / std::sqrt(static_cast<double>(known)) / map.deviation_mm;
  return out.clear >= kRuleClear ? std::optional(out) : std::nullopt;
}

/// Half steps about a path, as long as it gets clearer.
RulePath refined(const RulingMap& map, RulePath path, double slope_step, double bend_step) {
  double best = score(map, path).clear;
  for (int round = 0; round < 4; ++round) {
    const RulePath about = path;
    for (const double row : {-1.0, 0.0, 1.0})
      for (const double slope : {-0.5, 0.0, 0.5})
        for (const double bend : {-0.5, 0.0, 0.5}) {
          const RulePath tried{about.row + row, about.slope + slope * slope_step, about.bend + bend * bend_step};
          const double clear = score(map, tried).clear;
          if (clear > best) best = clear, path = tried;
        }
  }
  return path;
}

std::vector<SeenRule> rules_of(const RulingMap& map, const RuledSide& side, double shortest_mm) {
  std::vector<SeenRule> out;
  if (map.columns < 4 || !(map.deviation_mm > 0.0)) return out;
  const double column = side.column_mm, step = side.map.step_mm;  // mm
  const double slope_step = std::tan(kRuleClimbStep * std::numbers::pi / 180.0) * column / step;
  const double bend_step = kRuleBendStep * column * column / step;
  const int slopes = static_cast<int>(std::lround(kRuleClimb / kRuleClimbStep)),
            bends = static_cast<int>(std::lround(kRuleBend / kRuleBendStep));
  std::vector<std::pair<double, RulePath>> best(static_cast<std::size_t>(map.rows));
  const auto least = static_cast<int>(kRuleKnown * shortest_mm / column);
  for (int row = 0; row < map.rows; ++row)
    for (int s = -slopes; s <= slopes; ++s)
      for (int b = -bends; b <= bends; ++b) {
        const RulePath path{static_cast<double>(row), s * slope_step, b * bend_step};
        const RuleScore found = score(map, path);
        auto& here = best[static_cast<std::size_t>(row)];
        if (found.known >= least && found.clear > here.first) here = {found.clear, path};
      }
  std::stable_sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<RulePath> taken;
  const double apart = kRuleApart / step;
  for (const auto& [clear, path] : best) {
    if (clear < 0.6 * kRuleClear) break;
    const auto near = [&](const RulePath& other) {  // anywhere on the way: two rulings do not cross
      for (int c = 0; c < map.columns; ++c)
        if (std::abs(path.at(c - 0.5 * map.columns) - other.at(c - 0.5 * map.columns)) < apart) return true;
      return false;
    };
    if (std::any_of(taken.begin(), taken.end(), near)) continue;
    const RulePath fine = refined(map, path, slope_step, bend_step);
    if (auto rule = seen_stretch(map, fine, column, shortest_mm)) {
      out.push_back(*rule);
      taken.push_back(fine);
    }
  }
  return out;
}

ScriptRuling on_surface(const SeenRule& rule, const RulingMap& map, const RuledSide& side, TextSide which) {
  ScriptRuling out;
  out.side = which;
  out.depth_mm = rule.depth_mm;
  out.clear = rule.clear;
  const int wide = std::max(1, static_cast<int>(std::lround(side.column_mm / side.map.step_mm)));
  const double length = (rule.to - rule.from) * side.column_mm;
  const int pieces = std::max(1, static_cast<int>(std::lround(length / kRulePointEvery)));
  double height = 0.0;
  bool known = false;
  std::vector<std::pair<glm::dvec2, double>> points;
  for (int k = 0; k <= pieces; ++k) {
    const double column = rule.from + (rule.to - rule.from) * k / pieces;
    const double row = rule.path.at(column - 0.5 - 0.5 * map.columns);
    const double x = column * wide - 0.5;
    // The nearest known height along the way: wedges are unknown.
    for (int off = 0; off < 4 * wide; ++off) {
      bool found = false;
      for (const int way : {-1, 1}) {
        const int i = static_cast<int>(std::lround(x)) + way * off, j = static_cast<int>(std::lround(row));
        if (i < 0 || j < 0 || i >= side.map.width || j >= side.map.height || std::isnan(side.map.at(i, j))) continue;
        height = static_cast<double>(side.map.at(i, j));
        found = known = true;
        break;
      }
      if (found) break;
    }
    points.push_back({side.low + side.map.step_mm * glm::dvec2(x, row), height});
    if (known)
      for (auto& [at, z] : points)
        if (z == 0.0) z = height;
  }
  for (const auto& [at, z] : points)
    out.line_mm.push_back(at.x * side.axes.right + at.y * side.axes.up + z * side.axes.front);
  return out;
}

double median_edge(std::span<const glm::dvec3> points, std::span<const Triangle> triangles) {
  std::vector<double> edges;
  const std::size_t every = std::max<std::size_t>(1, triangles.size() / 20000);
  for (std::size_t t = 0; t < triangles.size(); t += every)
    edges.push_back(glm::distance(points[triangles[t][0]], points[triangles[t][1]]));
  return median(edges);
}

}  // namespace

std::vector<ScriptRuling> find_rulings(const TriMesh& mesh, const TextSides& sides,
                                       std::span<const ScriptWedge> wedges) {
  const std::vector<glm::dvec3> points = places_mm(mesh);
  const std::vector<Triangle> triangles = measured_triangles(mesh);
  std::vector<ScriptRuling> out;
  if (triangles.empty()) return out;
  std::vector<double> widths;
  for (const ScriptWedge& w : wedges) widths.push_back(w.width_mm);
  const double edge = median_edge(points, triangles), shortest = std::max(kRuleShortest, kRuleHeads * median(widths));
  for (std::size_t s = 0; s < kTextSideCount; ++s) {
    const auto which = static_cast<TextSide>(s);
    const RuledSide side = ruled_side(points, triangles, sides, which, wedges, std::clamp(0.5 * edge, 0.06, 0.25));
    // Each ruling as it is clearest.
    std::vector<std::pair<ScriptRuling, double>> found;  // and its height in the side
    for (const double reach : kRuleReaches) {
      const RulingMap map = ruling_map(side, std::max(reach, 1.5 * edge * reach / kRuleReaches[0]), kRuleClip);
      for (const SeenRule& rule : rules_of(map, side, shortest)) {
        ScriptRuling ruling = on_surface(rule, map, side, which);
        const double height = glm::dot(ruling.line_mm[ruling.line_mm.size() / 2], side.axes.up);
        const auto same = std::find_if(found.begin(), found.end(),
                                       [&](const auto& each) { return std::abs(each.second - height) < kRuleApart; });
        if (same == found.end())
          found.emplace_back(std::move(ruling), height);
        else if (ruling.clear > same->first.clear)
          *same = {std::move(ruling), height};
      }
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    for (auto& [ruling, height] : found) out.push_back(std::move(ruling));
  }
  return out;
}

}  // namespace dubsar
