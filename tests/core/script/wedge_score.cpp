#include "tests/core/script/wedge_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <set>

namespace dubsar {
namespace {

double share_of(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

double middle_of(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::string spread_of(const std::vector<double>& values) {
  return fmt::format("{:.3f} ({:.2f} to {:.2f})", middle_of(values), share_of(values, 0.1), share_of(values, 0.9));
}

double degrees_between(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& out) {
  const auto flat = [&](const glm::dvec3& v) { return glm::normalize(v - out * glm::dot(v, out)); };
  return std::acos(std::clamp(glm::dot(flat(a), flat(b)), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

bool same_kind(WedgeKind found, phantom::StrokeKind pressed) {
  return name_in(kWedgeKinds, found) == name_in(phantom::kStrokeKinds, pressed);
}

}  // namespace

WedgeScore judge_wedges(const phantom::Phantom& truth, std::span<const ScriptWedge> found, const WedgeJudging& how) {
  constexpr double kHead = 1.0, kTurned = 15.0, kSlit = 1.5;
  const double voxel = truth.options().voxel_mm;
  const auto& wedges = truth.wedges();
  WedgeScore score;
  score.wanted_of_kind.assign(std::size(phantom::kStrokeKinds), 0);
  score.found_of_kind = score.wanted_of_kind;
  score.wanted_of_side.assign(phantom::kSides, 0);
  score.found_of_side = score.wanted_of_side;
  score.judged.resize(found.size());
  struct Pair {
    double off;
    std::size_t found, truth;
  };
  std::vector<Pair> pairs;
  for (std::size_t f = 0; f < found.size(); ++f)
    for (std::size_t t = 0; t < wedges.size(); ++t) {
      const phantom::Wedge& w = wedges[t];
      if (w.owner != how.owner) continue;
      const double off = glm::distance(found[f].head_mm / voxel, w.place.head) / w.head_half_width;
      if (off > 3.0 || glm::dot(found[f].normal, w.outward) < 0.3) continue;
      const double turned = degrees_between(found[f].direction, w.tail, w.outward);
      if (off < score.judged[f].head_off)
        score.judged[f].near = static_cast<int>(t), score.judged[f].head_off = off, score.judged[f].turned_deg = turned;
      if (off <= kHead && turned <= kTurned) pairs.push_back({off, f, t});
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.off < b.off; });
  std::vector<int> found_by(wedges.size(), -1);
  for (const Pair& pair : pairs)
    if (found_by[pair.truth] < 0 && score.judged[pair.found].truth < 0) {
      found_by[pair.truth] = static_cast<int>(pair.found);
      score.judged[pair.found].truth = static_cast<int>(pair.truth);
    }
  score.drawn = static_cast<int>(found.size());
  for (const JudgedWedge& one : score.judged) {
    score.real += one.truth >= 0;
    score.placed += one.head_off <= kHead;
  }
  std::map<std::array<int, 2>, std::map<int, int>> lines;  // of found lines, how many of which true ones
  std::vector<std::array<int, 3>> in_line;
  for (std::size_t t = 0; t < wedges.size(); ++t) {
    const phantom::Wedge& w = wedges[t];
    if (w.owner != how.owner || !w.has_air() || w.depth < how.least_depth_vox) continue;
    if (w.owner == phantom::Owner::kTablet && w.state == phantom::WedgeCase::kFree &&
        truth.gap_width(w.position) < kSlit * how.grid_step)
      continue;
    ++score.wanted;
    ++score.wanted_of_kind[static_cast<std::size_t>(w.kind)];
    ++score.wanted_of_side[static_cast<std::size_t>(w.side)];
    if (found_by[t] < 0) {
      score.missed.push_back(static_cast<int>(t));
      continue;
    }
    const ScriptWedge& f = found[static_cast<std::size_t>(found_by[t])];
    ++score.found;
    ++score.found_of_kind[static_cast<std::size_t>(w.kind)];
    ++score.found_of_side[static_cast<std::size_t>(w.side)];
    score.kind_right += same_kind(f.kind, w.kind);
    score.depth_ratios.push_back(f.depth_mm / voxel / w.depth);
    score.length_ratios.push_back(f.length_mm / voxel / glm::distance(w.place.head, w.place.end));
    score.width_ratios.push_back(f.width_mm / voxel / (2.0 * w.head_half_width));
    score.direction_deg.push_back(degrees_between(f.direction, w.tail, w.outward));
    score.head_off_vox.push_back(glm::distance(f.head_mm / voxel, w.place.head));
    const glm::dvec3 half = w.head_half_width * glm::cross(w.outward, w.tail);
    for (const auto& [corner, side] : {std::pair(f.corner_mm[0], 1.0), std::pair(f.corner_mm[1], -1.0)}) {
      const glm::dvec3 off = corner / voxel - (w.place.head + side * half);
      score.corner_squares += glm::dot(off, off) / 2.0;
    }
    const std::array<int, 2> of{static_cast<int>(f.side), 100 * f.column + f.line};
    const int pressed = 1000 * static_cast<int>(w.side) + w.line;
    ++lines[of][pressed];
    in_line.push_back({of[0], of[1], pressed});
  }
  for (std::size_t f = 0; f < found.size(); ++f)
    for (std::size_t g = f + 1; g < found.size(); ++g) {
      const int t = score.judged[f].truth, u = score.judged[g].truth;
      if (t < 0 || u < 0 || !truth.overlap(static_cast<std::size_t>(t), static_cast<std::size_t>(u))) continue;
      ++score.pairs;
      const auto after = [&](std::size_t later, std::size_t earlier, bool right) {
        for (const WedgeBefore& before : found[later].pressed_after)
          if (before.order == found[earlier].order) {
            ++score.pairs_told;
            score.pairs_right += right;
            score.pair_clear.push_back({before.clear, right ? 1.0 : 0.0});
          }
      };
      after(f, g, t > u);
      after(g, f, u > t);
    }
  // A line that was found is one that was pressed, and no other is the same: those that share most wedges, first.
  std::vector<std::array<int, 4>> shared;  // wedges, side, line, pressed
  for (const auto& [found_line, pressed_lines] : lines)
    for (const auto& [pressed, count] : pressed_lines) shared.push_back({count, found_line[0], found_line[1], pressed});
  std::stable_sort(shared.begin(), shared.end(), [](const auto& a, const auto& b) { return a[0] > b[0]; });
  std::map<std::array<int, 2>, int> is_line;
  std::set<int> taken;
  for (const auto& [count, side, line, pressed] : shared)
    if (line % 100 > 0 && !is_line.contains({side, line}) && taken.insert(pressed).second)
      is_line[{side, line}] = pressed;
  for (const auto& [side, line, pressed] : in_line) {
    const auto is = is_line.find({side, line});
    score.line_right += is != is_line.end() && is->second == pressed;
  }
  return score;
}

void WedgeScore::add(const WedgeScore& o) {
  wanted += o.wanted, found += o.found, drawn += o.drawn, real += o.real, placed += o.placed;
  kind_right += o.kind_right, line_right += o.line_right;
  const auto join = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  corner_squares += o.corner_squares;
  pairs += o.pairs, pairs_told += o.pairs_told, pairs_right += o.pairs_right;
  join(pair_clear, o.pair_clear);
  join(depth_ratios, o.depth_ratios);
  join(length_ratios, o.length_ratios);
  join(width_ratios, o.width_ratios);
  join(direction_deg, o.direction_deg);
  join(head_off_vox, o.head_off_vox);
  const auto sum = [](std::vector<int>& to, const std::vector<int>& from) {
    to.resize(std::max(to.size(), from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
  };
  sum(wanted_of_kind, o.wanted_of_kind);
  sum(found_of_kind, o.found_of_kind);
  sum(wanted_of_side, o.wanted_of_side);
  sum(found_of_side, o.found_of_side);
}

std::string WedgeScore::text() const {
  std::vector<double> off;
  for (const double r : depth_ratios) off.push_back(std::abs(r - 1.0));
  std::string out = fmt::format(
      "wanted {} found {} ({:.3f}); drawn {} real {} ({:.3f}) placed {}; kind {:.3f}; line {:.3f}; depth ratio {:.3f}, "
      "error {:.3f}; direction {:.1f} deg, head {:.2f} vox, corners RMS {:.2f} vox;",
      wanted, found, recall(), drawn, real, precision(), placed, kind_share(),
      found ? static_cast<double>(line_right) / found : 0.0, middle_of(depth_ratios), middle_of(off),
      middle_of(direction_deg), middle_of(head_off_vox), found ? std::sqrt(corner_squares / found) : 0.0);
  out += fmt::format(" length ratio {}, width ratio {};", spread_of(length_ratios), spread_of(width_ratios));
  out += fmt::format(" of {} pairs order of {} told, {} right;", pairs, pairs_told, pairs_right);
  for (std::size_t k = 0; k < wanted_of_kind.size(); ++k)
    if (wanted_of_kind[k])
      out += fmt::format(" {} {:.2f}", phantom::kStrokeKinds[k].name.substr(0, 9),
                         static_cast<double>(found_of_kind[k]) / wanted_of_kind[k]);
  for (std::size_t k = 0; k < wanted_of_side.size(); ++k)
    if (wanted_of_side[k])
      out += fmt::format(" side{} {:.2f}/{}", k, static_cast<double>(found_of_side[k]) / wanted_of_side[k],
                         wanted_of_side[k]);
  return out;
}

}  // namespace dubsar
