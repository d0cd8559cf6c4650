#include "core/script/explain_relief.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <numeric>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::size_t kMostWays = 4;
constexpr double kWaysApart = 0.6;        // radians between two ways that a place is explained
constexpr double kClearMargin = 6e-4;     // a tenth of what a usual wedge explains
constexpr double kSameTurn = 0.35;        // radians: the same way
constexpr double kNeighbourWidths = 4.5;  // farther imprints explain nothing of a window
// Median widths: the broadest of 1,346 that were pressed is 1.5. What is broader explains a step beside a patch or the
// tablet's edge, and takes the wedges beside it with it.
constexpr double kMostBreadth = 1.75;
constexpr double kCostShare = 0.2;  // of what a usual wedge explains
constexpr double kCostLeast = 0.5;  // of the most: clay that nobody wrote on has usual ones, too, that explain little
double level_at(const WedgeSite& site, double x, double y) {
  double best = 1e30, level = 0.0;
  for (std::size_t i = 0; i < site.samples.size(); ++i) {
    const double dx = static_cast<double>(site.samples.x[i]) - x, dy = static_cast<double>(site.samples.y[i]) - y;
    if (dx * dx + dy * dy < best) {
      best = dx * dx + dy * dy;
      level = static_cast<double>(site.samples.level[i]);
    }
  }
  return level;
}

}  // namespace

ReliefExplanation::ReliefExplanation(SurfaceLevels& surface, const WedgeScale& scale,
                                     const std::vector<DeepPlace>& places)
    : fine_(&surface.fine()),
      cells_(&surface.for_width(scale.width_mm)),
      scale_(scale),
      sites_(places.size()),
      fits_(places.size()) {
  parallel_for(static_cast<std::int64_t>(places.size()), 4, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    sites_[k] = wedge_site(*cells_, scale, places[k]);
    fit_alone(k);
  });
  find_neighbours();
}

void ReliefExplanation::fit_alone(std::size_t k) {
  const WedgeSite& site = sites_[k];
  Fit& fit = fits_[k];
  if (site.samples.size() < 100) return;
  const UsualImprint usual = scale_.usual();
  std::vector<ImprintStart> starts = imprint_starts(site.coarse, usual, site.x, site.y, kStartDirections, kFitAlone);
  std::stable_sort(starts.begin(), starts.end(),
                   [](const ImprintStart& a, const ImprintStart& b) { return a.energy < b.energy; });
  const auto differs = [&](double angle) {
    return std::all_of(fit.ways.begin(), fit.ways.end(), [&](const ImprintStart& way) {
      return angle_apart(way.imprint.p[Imprint::kAngle], angle) > kWaysApart;
    });
  };
  for (const ImprintStart& start : starts) {
    if (fit.ways.size() == kMostWays) break;
    if (differs(start.imprint.p[Imprint::kAngle])) fit.ways.push_back(start);
  }
  for (ImprintStart& way : fit.ways) way.energy = fit_imprint(way.imprint, site.samples, usual, kFitAlone);
  std::stable_sort(fit.ways.begin(), fit.ways.end(),
                   [](const ImprintStart& a, const ImprintStart& b) { return a.energy < b.energy; });
  fit.imprint = fit.ways.front().imprint;
  fit.gain = empty_energy(site.samples, kFitAlone) - fit.ways.front().energy;
}

void ReliefExplanation::find_neighbours() {
  near_.resize(sites_.size());
  const double reach = kNeighbourWidths * scale_.width_mm;
  std::map<std::array<std::int64_t, 3>, std::vector<std::uint32_t>> cubes;
  const auto cube_of = [&](const glm::dvec3& p) {
    std::array<std::int64_t, 3> c{};
    for (int a = 0; a < 3; ++a) c[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::floor(p[a] / reach));
    return c;
  };
  for (std::size_t k = 0; k < sites_.size(); ++k)
    cubes[cube_of(sites_[k].origin)].push_back(static_cast<std::uint32_t>(k));
  for (std::size_t k = 0; k < sites_.size(); ++k) {
    const auto c = cube_of(sites_[k].origin);
    for (std::int64_t z = -1; z <= 1; ++z)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t x = -1; x <= 1; ++x) {
          const auto cube = cubes.find({c[0] + x, c[1] + y, c[2] + z});
          if (cube == cubes.end()) continue;
          for (const std::uint32_t j : cube->second)
            if (j != k && glm::distance(sites_[j].origin, sites_[k].origin) < reach &&
                glm::dot(sites_[j].out, sites_[k].out) > 0.0)
              near_[k].push_back(j);
        }
    std::sort(near_[k].begin(), near_[k].end());
  }
}

glm::dvec3 ReliefExplanation::on_axis(std::size_t k, double along) const {
  const WedgeSite& site = sites_[k];
  const Imprint& i = fits_[k].imprint;
  const double angle = i.p[Imprint::kAngle];
  const double u = i.p[Imprint::kX] + along * std::cos(angle), v = i.p[Imprint::kY] + along * std::sin(angle);
  return site.origin + scale_.width_mm * (site.right * u + site.up * v + site.out * level_at(site, u, v));
}

PlacedImprint ReliefExplanation::placed_at(std::size_t k) const {
  const WedgeSite& site = sites_[k];
  const Imprint& i = fits_[k].imprint;
  PlacedImprint out;
  const double angle = i.p[Imprint::kAngle];
  out.foot = on_axis(k, 0.0);
  out.head = on_axis(k, -i.back());
  out.end = on_axis(k, i.reach());
  out.normal = site.out;
  out.along = std::cos(angle) * site.right + std::sin(angle) * site.up;
  out.imprint = i;
  out.site = k;
  out.gain = fits_[k].gain;
  out.margin = fits_[k].margin;
  out.thirds = fits_[k].thirds;
  out.seen = site.seen;
  return out;
}

void ReliefExplanation::look_beside(std::size_t k, DepthSamples& samples) const {
  const WedgeSite& site = sites_[k];
  std::fill(samples.others.begin(), samples.others.end(), 0.0f);
  for (const std::uint32_t j : near_[k])
    if (fits_[j].active) add_other(site, placed_at(j), samples);
}

void ReliefExplanation::add_other(const WedgeSite& site, const PlacedImprint& other, DepthSamples& samples) const {
  const glm::dvec3 off = (site.origin - other.foot) / scale_.width_mm;
  const auto along = [&](const glm::dvec3& axis) {
    return std::array<float, 4>{static_cast<float>(glm::dot(off, axis)), static_cast<float>(glm::dot(site.right, axis)),
                                static_cast<float>(glm::dot(site.up, axis)),
                                static_cast<float>(glm::dot(site.out, axis))};
  };
  explain_by_other(other.imprint,
                   {along(other.along), along(glm::cross(other.normal, other.along)), along(other.normal)}, samples);
}

double ReliefExplanation::gain_beside(std::size_t k, const Imprint& imprint, DepthSamples& samples) const {
  look_beside(k, samples);
  return empty_energy(samples, kFitTogether) - imprint_energy(imprint, samples, scale_.usual(), kFitTogether);
}

double ReliefExplanation::doubt(const WedgeSite& site, const Imprint& imprint) const {
  // What tells a Winkelhaken from itself turned by a third, on phantoms; a fiftieth of what a tail does.
  constexpr double kNat = 8e-5;
  if (!surprise_) return 0.0;
  const double angle = imprint.p[Imprint::kAngle];
  return kNat * surprise_(std::cos(angle) * site.right + std::sin(angle) * site.up, site.out, imprint);
}

void ReliefExplanation::fit_beside(std::size_t k, Fit& out) const {
  if (out.ways.empty() || (!out.active && out.hopeless)) return;
  DepthSamples samples = sites_[k].samples;
  look_beside(k, samples);
  std::vector<ImprintStart> ways, plain;  // with what is surprising about them, and without
  const auto add = [&](Imprint start) {
    ImprintStart way{start, 0.0};
    way.energy = fit_imprint(way.imprint, samples, scale_.usual(), kFitTogether);
    plain.push_back(way);
    way.energy += doubt(sites_[k], way.imprint);
    ways.push_back(way);
  };
  add(out.imprint);
  const bool clear = out.active && out.margin > kClearMargin;  // nothing else came near it before
  for (const ImprintStart& way : out.ways)
    if (!clear && angle_apart(way.imprint.p[Imprint::kAngle], out.imprint.p[Imprint::kAngle]) > kWaysApart)
      add(way.imprint);
  for (const double turn : {-1.0, 1.0}) {
    if (clear) break;
    Imprint turned = ways.front().imprint;
    turned.p[Imprint::kAngle] += turn * 2.0 * std::numbers::pi / 3.0;
    add(turned);
  }
  // With a tail or without one, whichever it had not.
  Imprint other = ways.front().imprint;
  other.tailed = !other.tailed;
  if (other.tailed) other.p[Imprint::kTail] = std::max(std::log(1.6), other.p[Imprint::kFront] + 0.3);
  add(other);
  std::stable_sort(ways.begin(), ways.end(),
                   [](const ImprintStart& a, const ImprintStart& b) { return a.energy < b.energy; });
  out.imprint = ways.front().imprint;
  out.gain = empty_energy(samples, kFitTogether) - ways.front().energy;
  if (clear) return;
  out.margin = out.gain;
  const double angle = out.imprint.p[Imprint::kAngle];
  const auto best_near = [&](double at) {
    double best = 1e30;
    for (const ImprintStart& way : plain)
      if (angle_apart(way.imprint.p[Imprint::kAngle], at) < kSameTurn) best = std::min(best, way.energy);
    return best;
  };
  for (const std::size_t t : {std::size_t{0}, std::size_t{1}})
    out.thirds[t] =
        std::min(kNoTurn, best_near(angle + (t == 0 ? 1.0 : -1.0) * 2.0 * std::numbers::pi / 3.0) - best_near(angle));
  for (const ImprintStart& way : ways)
    if (angle_apart(way.imprint.p[Imprint::kAngle], out.imprint.p[Imprint::kAngle]) > kWaysApart)
      out.margin = std::min(out.margin, way.energy - ways.front().energy);
}

void ReliefExplanation::drop_broad() {
  std::vector<double> widths;
  for (const Fit& fit : fits_)
    if (fit.active) widths.push_back(fit.imprint.width());
  const double most = kMostBreadth * std::max(1.0, median(widths));
  for (Fit& fit : fits_) fit.active = fit.active && fit.imprint.width() <= most;
}

double ReliefExplanation::usual_gain() const {
  std::vector<double> gains;
  for (const Fit& fit : fits_)
    if (fit.active) gains.push_back(fit.gain);
  return gains.empty() ? 0.0 : median(gains);
}

void ReliefExplanation::explain(int rounds, double most_cost) {
  double cost = most_cost;
  const auto know_cost = [&] {
    if (const double usual = usual_gain(); usual > 0.0)
      cost = std::clamp(kCostShare * usual, kCostLeast * most_cost, most_cost);
  };
  know_cost();
  std::vector<std::size_t> order(sites_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto by_gain = [&](bool most_first) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return most_first ? fits_[a].gain > fits_[b].gain : fits_[a].gain < fits_[b].gain;
    });
  };
  const auto take_in = [&] {
    by_gain(true);
    for (const std::size_t k : order) {
      if (fits_[k].active || fits_[k].ways.empty() || fits_[k].gain < cost) continue;
      DepthSamples samples = sites_[k].samples;
      const double gain = gain_beside(k, fits_[k].imprint, samples);
      fits_[k].active = gain > cost;
      fits_[k].gain = gain;
    }
  };
  take_in();
  for (int round = 0; round < rounds; ++round) {
    know_cost();
    std::vector<Fit> next = fits_;
    parallel_for(static_cast<std::int64_t>(sites_.size()), 2,
                 [&](std::int64_t i) { fit_beside(static_cast<std::size_t>(i), next[static_cast<std::size_t>(i)]); });
    fits_ = std::move(next);
    for (Fit& fit : fits_) fit.hopeless = !fit.active && fit.gain < 0.7 * cost;
    by_gain(false);
    drop_broad();
    for (const std::size_t k : order) {
      if (!fits_[k].active) continue;
      DepthSamples samples = sites_[k].samples;
      fits_[k].gain = gain_beside(k, fits_[k].imprint, samples);
      fits_[k].active = fits_[k].gain > cost;
    }
    if (round + 1 < rounds) {
      take_in();
      split(cost);
      for (std::size_t k = order.size(); k < sites_.size(); ++k) order.push_back(k);
    }
  }
}

}  // namespace dubsar
