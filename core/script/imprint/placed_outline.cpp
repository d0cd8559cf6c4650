// Where a wedge ends on the clay: its tail and the corners of its head, from the relief itself. The planes that find it
// are broader and longer, as valleys and rims are round.

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel.h"
#include "core/script/explain_relief.h"

namespace dubsar {
namespace {

// Widths, where nothing else is said.
constexpr double kOutlineSteps = 10.0;                         // samples over one
constexpr double kOutlineAside = 1.3;                          // beside the axis, that is looked at
constexpr double kOutlineMargin = 1.0;                         // around it, as the ball that is rolled over it needs
constexpr double kOutlineBall = 4.0;                           // its radius, as where wedges are looked for
constexpr double kOutlineLevel = 0.25;                         // of a patch that is certainly level
constexpr double kOutlineFarther = 1.3, kOutlineBeyond = 0.5;  // of the fitted reach, and more: as far as a tail may go
constexpr double kOutlineFloor = 0.12;                         // the floor is looked for so far beside the axis
constexpr double kOutlineSame = 0.1;  // of the depth: what others explain as well as this wedge
// Of the deepest: where the head's steep part is over; what is level. Phantoms' floors (785001, 788101, 790001).
constexpr double kOutlineBegin = 0.65, kOutlineFlat = 0.12;
constexpr double kOutlineKnee = 0.5;  // from there to the end: the groove alone
constexpr double kOutlineHidden = 1.2;
constexpr double kOutlineSeen = 0.5;    // of the groove's places: fewer are no measure
constexpr std::size_t kOutlineFew = 5;  // wedges that tell what is usual

/// The relief as a wedge sees it: depth below level clay by place, in widths; u along the tail from T, v across.
struct OutlineRelief {
  TangentPatch patch;
  std::vector<float> depth, others;                   ///< of the clay; what other wedges explain
  glm::dvec2 origin{0.0}, along{1, 0}, across{0, 1};  ///< of T, and the axes, on the patch, in samples

  double at(const std::vector<float>& values, double u, double v) const {
    const glm::dvec2 p = origin + kOutlineSteps * (u * along + v * across);
    const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y)), half = patch.half;
    if (x < -half || y < -half || x >= half || y >= half) return std::nan("");
    const double fx = p.x - x, fy = p.y - y;
    const auto value = [&](int i, int j) { return static_cast<double>(values[patch.index(i, j)]); };
    return (1 - fy) * ((1 - fx) * value(x, y) + fx * value(x + 1, y)) +
           fy * ((1 - fx) * value(x, y + 1) + fx * value(x + 1, y + 1));
  }
};

struct OutlinePlace {
  double u = 0.0, depth = 0.0;  ///< NaN: not known, or another wedge's
};

double deepest_of(const std::vector<OutlinePlace>& floor) {
  double deepest = 0.0;
  for (const OutlinePlace& p : floor)
    if (p.u < 0.5 && p.depth > deepest) deepest = p.depth;
  return deepest;
}

/// The deepest places beside the axis, a mean over three along it.
std::vector<OutlinePlace> floor_of(const OutlineRelief& relief, double to, double deep) {
  constexpr double kFrom = -0.3, kStep = 1.0 / kOutlineSteps;
  std::vector<OutlinePlace> out;
  for (int k = 0; kFrom + k * kStep <= to; ++k) {
    OutlinePlace place{kFrom + k * kStep, std::nan("")};
    double other = 0.0;
    for (int a = -2; a <= 2; ++a) {
      const double v = 0.5 * a * kOutlineFloor;
      double sum = 0.0;
      for (int j = -1; j <= 1; ++j) sum += relief.at(relief.depth, place.u + j * kStep, v) * (j == 0 ? 0.5 : 0.25);
      if (std::isnan(sum) || sum <= place.depth) continue;
      place.depth = sum;
      other = relief.at(relief.others, place.u, v);
    }
    const double same = kOutlineSame * deep;
    if (other > same && place.depth < other + same && place.depth > 0.5 * other) place.depth = std::nan("");
    out.push_back(place);
  }
  return out;
}

/// A groove only gets shallower: behind a place that is deeper than one before it, all but level clay is another's.
void forget_others(std::vector<OutlinePlace>& floor, double begin, double deep) {
  constexpr double kDeeper = 0.06, kRises = 0.1;  // of the deepest: noise; what the shallowest groove rises in a width
  double least = 1e30, at = begin;
  bool over = false;
  for (OutlinePlace& p : floor) {
    if (p.u < begin || std::isnan(p.depth)) continue;
    over = over || p.depth > least + (kDeeper - kRises * (p.u - at)) * deep;
    if (over && p.depth > kOutlineFlat * deep) p.depth = std::nan("");
    if (p.depth < least) least = p.depth, at = p.u;
  }
}

/// Ramps that come back to level clay between two ends, as parts of the deepest at `begin`.
struct OutlineRamps {
  double begin, until;  ///< places that count
  double least_end, most_end;
  double least, most;  ///< of the deepest, at `begin`
  double bound;        ///< of the deepest: what misses by more is something else
};

/// Where the ramp that misses the floor least comes back to level clay; deeper places count half, as others only dig
/// deeper. 0 without one.
double ramp_end(const std::vector<OutlinePlace>& floor, double deep, const OutlineRamps& ramps) {
  constexpr double kLeastSlope = 0.04, kMostSlope = 3.0, kEndStep = 0.025;  // of the deepest a width
  constexpr int kSlopes = 60;
  constexpr double kHidden = 0.5;
  std::vector<OutlinePlace> seen;
  for (const OutlinePlace& p : floor)
    if (p.u > ramps.begin - 1e-9 && p.u < ramps.until && !std::isnan(p.depth)) seen.push_back({p.u, p.depth / deep});
  if (seen.size() < 4 || seen.front().u > ramps.begin + kHidden) return 0.0;
  double best = 1e30, best_end = 0.0;
  for (double end = ramps.least_end; end <= std::min(ramps.most_end, seen.back().u + 0.3); end += kEndStep)
    for (int s = 0; s < kSlopes; ++s) {
      const double slope = kLeastSlope * std::pow(kMostSlope / kLeastSlope, s / (kSlopes - 1.0));
      const double first = slope * (end - ramps.begin);
      if (first < ramps.least || first > ramps.most) continue;
      double sum = 0.0;
      for (const OutlinePlace& p : seen) {
        const double r = (p.depth - std::max(0.0, slope * (end - p.u))) / ramps.bound;
        sum += (r > 0.0 ? 0.5 : 1.0) * r * r / (1.0 + r * r);
      }
      if (sum < best) best = sum, best_end = end;
    }
  return best_end;
}

/// Half of the head's breadth to one side at a place of the axis, where it is `level` deep; NaN: not seen.
double half_breadth(const OutlineRelief& relief, double u, double side, double level, double deep) {
  constexpr double kMost = 0.9, kStep = 0.05;
  double before = relief.at(relief.depth, u, 0.0);
  if (!(before > level)) return std::nan("");
  for (double v = kStep; v < kMost; v += kStep) {
    const double here = relief.at(relief.depth, u, side * v), other = relief.at(relief.others, u, side * v);
    if (std::isnan(here) || (other > kOutlineSame * deep && here < other + kOutlineSame * deep)) break;
    if (here <= level) return v - kStep * (level - here) / std::max(1e-9, before - here);
    before = here;
  }
  return std::nan("");
}

/// Between the corners: the head's greatest breadths where its walls are plane, followed up to level clay. 0: not seen.
double breadth_of_head(const OutlineRelief& relief, double back, double deep) {
  constexpr double kUpper = 0.3, kLower = 0.6;  // of the deepest: neither the round rim nor the round valley
  const auto greatest = [&](double share) {
    double most = 0.0;
    for (double u = -1.2 * back; u < 0.35; u += 0.05) {
      const double left = half_breadth(relief, u, 1.0, share * deep, deep),
                   right = half_breadth(relief, u, -1.0, share * deep, deep);
      const double both = std::isnan(left) ? 2.0 * right : std::isnan(right) ? 2.0 * left : left + right;
      if (both > most) most = both;
    }
    return most;
  };
  const double upper = greatest(kUpper), lower = greatest(kLower);
  return lower > 0.0 && upper > lower ? upper + (upper - lower) * kUpper / (kLower - kUpper) : 0.0;
}

}  // namespace

/// Reach of the tail, how sure, and breadth of one wedge beside the others as `drawn`.
ReliefExplanation::Outline ReliefExplanation::outline_of(const PlacedImprint& one,
                                                         const std::vector<Imprint>& drawn) const {
  const Imprint& i = one.imprint;
  const double to = kOutlineFarther * i.reach() + kOutlineBeyond, from = i.back() + kOutlineBeyond;
  const double half = std::max(0.5 * (to + from), kOutlineAside) + kOutlineMargin,
               step = scale_.width_mm / kOutlineSteps;
  OutlineRelief relief;
  relief.patch =
      tangent_patch(*cells_, one.foot + 0.5 * (to - from) * scale_.width_mm * one.along, one.normal,
                    {static_cast<int>(std::ceil(half * kOutlineSteps)), step, kOutlineBall * scale_.width_mm});
  const TangentPatch& patch = relief.patch;
  const auto flat = [&](const glm::dvec3& v) { return glm::dvec2(glm::dot(v, patch.right), glm::dot(v, patch.up)); };
  relief.origin = flat(one.foot - patch.origin) / step;
  relief.along = flat(one.along), relief.across = flat(glm::cross(one.normal, one.along));
  WedgeSite seen;
  seen.origin = patch.origin, seen.right = patch.right, seen.up = patch.up, seen.out = patch.out;
  std::vector<std::size_t> known;
  const auto unit = static_cast<float>(1.0 / scale_.width_mm);
  for (int y = -patch.half; y <= patch.half; ++y)
    for (int x = -patch.half; x <= patch.half; ++x) {
      const std::size_t at = patch.index(x, y);
      if (std::isnan(patch.depth[at])) continue;
      known.push_back(at);
      seen.samples.x.push_back(static_cast<float>(x / kOutlineSteps));
      seen.samples.y.push_back(static_cast<float>(y / kOutlineSteps));
      seen.samples.depth.push_back(patch.depth[at] * unit);
      seen.samples.level.push_back(patch.level[at] * unit);
    }
  Outline out;
  if (known.empty()) return out;
  std::vector<float> all = seen.samples.depth;  // noise rides on top of what the ball touches
  const auto level = all.begin() + static_cast<std::ptrdiff_t>(kOutlineLevel * static_cast<double>(all.size()));
  std::nth_element(all.begin(), level, all.end());
  seen.samples.others.assign(known.size(), 0.0f);
  for (const std::uint32_t j : near_[one.site]) {
    if (!fits_[j].active) continue;
    PlacedImprint other = placed_at(j);
    other.imprint = drawn[j];
    add_other(seen, other, seen.samples);
  }
  relief.depth.assign(patch.depth.size(), std::numeric_limits<float>::quiet_NaN());
  relief.others.assign(patch.depth.size(), 0.0f);
  for (std::size_t k = 0; k < known.size(); ++k) {
    relief.depth[known[k]] = seen.samples.depth[k] - *level;
    relief.others[known[k]] = seen.samples.others[k];
  }
  std::vector<OutlinePlace> floor = floor_of(relief, to, one.depth);
  const double deep = deepest_of(floor);
  if (!(deep > 0.0)) return out;
  out.breadth = breadth_of_head(relief, i.back(), deep);
  double begin = -1.0;
  for (const OutlinePlace& p : floor) {
    if (begin >= 0.0 && !(p.depth > kOutlineBegin * deep)) break;
    if (p.depth > kOutlineBegin * deep) begin = std::max(0.0, p.u);
  }
  forget_others(floor, begin, deep);
  out.least = begin, out.most = 1e30;
  for (const OutlinePlace& p : floor) {
    if (p.u < begin || std::isnan(p.depth)) continue;
    if (p.depth < kOutlineFlat * deep) {
      out.most = p.u;
      break;
    }
    out.least = p.u;
  }
  // Once with the end of the head, which is steeper, then the groove alone, near the end that was found.
  out.reach = ramp_end(floor, deep, {begin, 1e30, begin + 0.1, 1e30, 0.3, 1.1, 0.1});
  if (!(out.reach > 0.0)) return out;
  const double length = out.reach - begin, knee = begin + kOutlineKnee * length;
  int places = 0, open = 0;
  for (const OutlinePlace& p : floor)
    if (p.u > knee - 1e-9 && p.u < out.reach + 1e-9) ++places, open += std::isnan(p.depth) ? 0 : 1;
  const double end =
      ramp_end(floor, deep, {knee, begin + 2.0 * length, begin + 0.85 * length, begin + 1.3 * length, 0.1, 0.8, 0.06});
  out.seen = end > 0.0 && open >= kOutlineSeen * places;
  // The end of the head alone, which is steeper, leads to a fifth too little (the same phantoms).
  out.reach = out.seen ? end : begin + kOutlineHidden * length;
  return out;
}

void ReliefExplanation::draw_outlines(std::vector<PlacedImprint>& placed) const {
  std::vector<Imprint> drawn;
  for (const Fit& fit : fits_) drawn.push_back(fit.imprint);
  std::vector<Outline> outlines(placed.size());
  double reach = 1.0, breadth = 1.0;  // in the median, of those that were fitted
  // Twice, as fitted neighbours hide more than those that are drawn.
  for (int round = 0; round < 2; ++round) {
    parallel_for(static_cast<std::int64_t>(placed.size()), 4, [&](std::int64_t k) {
      const auto i = static_cast<std::size_t>(k);
      outlines[i] = outline_of(placed[i], drawn);
    });
    std::vector<double> reaches, breadths;
    for (std::size_t k = 0; k < placed.size(); ++k) {
      if (outlines[k].seen) reaches.push_back(outlines[k].reach / placed[k].imprint.reach());
      if (outlines[k].breadth > 0.0) breadths.push_back(outlines[k].breadth / placed[k].imprint.width());
    }
    if (reaches.size() >= kOutlineFew) reach = median(reaches);
    if (breadths.size() >= kOutlineFew) breadth = median(breadths);
    for (std::size_t k = 0; k < placed.size(); ++k) {
      const Outline& o = outlines[k];
      PlacedImprint& one = placed[k];
      // Hidden by others, a tail ends where what is seen of it leads to, else as usual ones do; but neither where it is
      // still deep nor behind what is level.
      const double guess = o.reach > 0.0 ? o.reach : reach * one.imprint.reach();
      one.outline.reach = o.seen || !(o.most > 0.0) ? guess : std::min(std::max(guess, o.least), o.most);
      one.end = on_axis(one.site, one.outline.reach);
      one.outline.width = breadth * one.imprint.width();
      Imprint& as = drawn[one.site];
      as = one.imprint;
      as.p[Imprint::kWidth] += std::log(breadth);
      as.p[Imprint::kTail] = std::log(std::max(0.05, one.outline.reach) / as.width());
    }
  }
}

}  // namespace dubsar
