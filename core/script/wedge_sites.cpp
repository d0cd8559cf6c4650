#include "core/script/wedge_sites.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr double kSiteSteps = 8.0;  // samples over a width
constexpr double kSiteBall = 4.0;   // radius in widths: finds wedges, and bridges no more than their width
constexpr double kSiteTile = 1.25, kSiteTileReach = 1.1, kSiteMargin = 2.0;  // widths
constexpr double kSiteApart = 0.25;                                          // widths between two deep places
constexpr double kSiteSteepest = 1.3;     // slope of the level in a tile: what leans more is seen better by another
constexpr double kSiteMostDepth = 1.5;    // widths: deeper than any wedge is
constexpr double kSiteDeviation = 0.9;    // of the weights, widths
constexpr double kSiteLevelShare = 0.25;  // of a patch that is certainly level

PatchSize patch_size(const WedgeScale& scale, double reach) {
  return {static_cast<int>(std::ceil(reach * kSiteSteps)), scale.width_mm / kSiteSteps, kSiteBall * scale.width_mm};
}

bool known(float v) { return !std::isnan(v); }

/// Binomial weights of three by three of what is known; -1 where nothing is.
std::vector<float> smoothed(const TangentPatch& patch) {
  std::vector<float> out(patch.depth.size(), -1.f);
  for (int y = 1 - patch.half; y < patch.half; ++y)
    for (int x = 1 - patch.half; x < patch.half; ++x) {
      if (!known(patch.depth[patch.index(x, y)])) continue;
      float sum = 0.f, weights = 0.f;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const float depth = patch.depth[patch.index(x + dx, y + dy)];
          const auto weight = static_cast<float>((2 - std::abs(dx)) * (2 - std::abs(dy)));
          if (!known(depth)) continue;
          sum += weight * depth;
          weights += weight;
        }
      out[patch.index(x, y)] = sum / weights;
    }
  return out;
}

/// Slope of the writing surface along one axis: over half a width each way, as far as it is known.
double level_slope(const TangentPatch& patch, int x, int y, int dx, int dy) {
  constexpr int kReach = static_cast<int>(0.5 * kSiteSteps);
  double sum = 0.0, count = 0.0;
  for (int k = -2; k <= 2; ++k) {
    int ahead = kReach, behind = -kReach;
    const auto level = [&](int along) {
      const int u = x + dx * along + dy * k, v = y + dy * along + dx * k;
      return std::max(std::abs(u), std::abs(v)) > patch.half ? std::nanf("") : patch.level[patch.index(u, v)];
    };
    while (ahead > behind && !known(level(ahead))) --ahead;
    while (behind < ahead && !known(level(behind))) ++behind;
    if (ahead - behind < kReach) continue;
    sum += static_cast<double>(level(ahead) - level(behind)) / ((ahead - behind) * patch.step_mm);
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

void add_places_of_tile(const PatchCells& cells, const PatchCells::Tile& tile, const WedgeScale& scale, double least_mm,
                        std::vector<DeepPlace>& out) {
  const TangentPatch patch =
      tangent_patch(cells, tile.middle, tile.normal, patch_size(scale, kSiteTileReach + kSiteMargin));
  const std::vector<float> depth = smoothed(patch);
  const int reach = static_cast<int>(kSiteTileReach * kSiteSteps), apart = 2;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      const float here = depth[patch.index(x, y)];
      if (!(static_cast<double>(here) >= least_mm) || x * x + y * y > reach * reach) continue;
      bool deepest = static_cast<double>(here) < kSiteMostDepth * scale.width_mm;
      for (int dy = -apart; dy <= apart && deepest; ++dy)
        for (int dx = -apart; dx <= apart && deepest; ++dx) {
          const bool before = dy < 0 || (dy == 0 && dx < 0);
          const float there = depth[patch.index(x + dx, y + dy)];
          deepest = before ? there < here : there <= here;
        }
      if (!deepest) continue;
      const double right = level_slope(patch, x, y, 1, 0), up = level_slope(patch, x, y, 0, 1);
      if (std::hypot(right, up) > kSiteSteepest) continue;
      out.push_back({patch.on_level(x, y), glm::normalize(patch.out - right * patch.right - up * patch.up),
                     static_cast<double>(here) / std::sqrt(1.0 + right * right + up * up)});
    }
}

}  // namespace

std::vector<DeepPlace> deep_places(const PatchCells& cells, const WedgeScale& scale, double least_depth, int skip) {
  const std::vector<PatchCells::Tile> tiles = cells.tiles(kSiteTile * scale.width_mm);
  const auto step = static_cast<std::size_t>(std::max(1, skip));
  std::vector<std::vector<DeepPlace>> found((tiles.size() + step - 1) / step);
  parallel_for(static_cast<std::int64_t>(found.size()), 4, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    add_places_of_tile(cells, tiles[i * step], scale, least_depth * scale.depth_mm, found[i]);
  });
  std::vector<DeepPlace> all;
  for (const auto& of_tile : found) all.insert(all.end(), of_tile.begin(), of_tile.end());
  // Deepest first; what lies beside a deeper one is the same place as another tile saw it.
  std::stable_sort(all.begin(), all.end(),
                   [](const DeepPlace& a, const DeepPlace& b) { return a.depth_mm > b.depth_mm; });
  const double apart = kSiteApart * scale.width_mm;
  std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> cubes;
  std::vector<DeepPlace> out;
  for (const DeepPlace& place : all) {
    std::array<std::int64_t, 3> cube{};
    for (int a = 0; a < 3; ++a)
      cube[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::floor(place.foot[a] / apart));
    bool fresh = true;
    for (std::int64_t z = -1; z <= 1 && fresh; ++z)
      for (std::int64_t y = -1; y <= 1 && fresh; ++y)
        for (std::int64_t x = -1; x <= 1 && fresh; ++x) {
          const auto near = cubes.find({cube[0] + x, cube[1] + y, cube[2] + z});
          if (near == cubes.end()) continue;
          for (const std::size_t k : near->second) fresh = fresh && glm::distance(out[k].foot, place.foot) > apart;
        }
    if (!fresh) continue;
    cubes[cube].push_back(out.size());
    out.push_back(place);
  }
  return out;
}

WedgeSite wedge_site(const PatchCells& cells, const WedgeScale& scale, const DeepPlace& place) {
  const TangentPatch patch = tangent_patch(cells, place.foot, place.normal, patch_size(scale, kSiteReach + 1.0));
  WedgeSite site;
  site.origin = place.foot, site.right = patch.right, site.up = patch.up, site.out = patch.out;
  std::vector<float> all;
  for (const float d : patch.depth)
    if (known(d)) all.push_back(d);
  float noise = 0.0f;
  if (!all.empty()) {  // noise rides on top of what the ball touches
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(kSiteLevelShare * static_cast<double>(all.size()));
    std::nth_element(all.begin(), at, all.end());
    noise = *at;
  }
  const auto unit = static_cast<float>(1.0 / scale.width_mm);
  const int reach = static_cast<int>(kSiteReach * kSiteSteps), middle = static_cast<int>(0.3 * kSiteSteps);
  double weights = 0.0;
  float deepest = -1.0f;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      if (x * x + y * y > reach * reach) continue;
      const double u = x / kSiteSteps, v = y / kSiteSteps;
      const double weight = std::exp(-0.5 * (u * u + v * v) / (kSiteDeviation * kSiteDeviation));
      weights += weight;
      const float depth = patch.depth[patch.index(x, y)];
      if (!known(depth)) continue;
      site.seen += weight;
      const float d = (depth - noise) * unit;
      const auto add = [&](DepthSamples& to) {
        to.x.push_back(static_cast<float>(u));
        to.y.push_back(static_cast<float>(v));
        to.depth.push_back(d);
        to.weight.push_back(static_cast<float>(weight));
        to.level.push_back(patch.level[patch.index(x, y)] * unit);
      };
      add(site.samples);
      if (x % 2 == 0 && y % 2 == 0) add(site.coarse);
      if (x * x + y * y <= middle * middle && d > deepest) {
        deepest = d;
        site.x = u, site.y = v;
      }
    }
  site.seen /= weights;
  site.samples.others.assign(site.samples.size(), 0.0f);
  site.coarse.others.assign(site.coarse.size(), 0.0f);
  site.samples.area = static_cast<float>(1.0 / (kSiteSteps * kSiteSteps));
  site.coarse.area = 4.0f * site.samples.area;
  return site;
}

}  // namespace dubsar
