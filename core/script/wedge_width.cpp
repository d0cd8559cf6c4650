#include "core/script/wedge_width.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/numbers/median.h"
#include "core/script/explain_relief.h"

namespace dubsar {
namespace {

constexpr int kScaleSizes = 4;
constexpr double kScaleFinest = 100.0;     // of the root of the two longest extents' product, the least width
constexpr double kScaleFewestEdges = 2.0;  // over a width
constexpr double kScaleDepth = 0.45;       // of a width, to begin with
constexpr double kScaleLeastDepth = 0.4;   // of that
constexpr double kScaleCost = 0.0012;
// What blur of a scan and the stylus's own corner leave: none, to half of a width.
constexpr std::array<double, 4> kScaleRoundings{0.0, 0.15, 0.3, 0.45};
constexpr int kScaleTiles = 700;
constexpr std::size_t kScalePlaces = 140;  // that are fitted, of those
constexpr std::size_t kScaleFewest = 5;
// A usual width made better by what was found at it has to be as clear as this share of what it was before. On fine
// meshes it is clearer; on coarse ones hollows of any size look like wider wedges, each time by a quarter.
constexpr double kScaleAsClear = 0.5;

struct Tried {
  WedgeScale scale;
  double explained = 0.0;  // gain times area
  std::vector<PlacedImprint> placed;

  /// What is explained, and how well where it is: gain over the area of heads, which has no unit and is most where the
  /// model is neither wider nor narrower than what was pressed.
  double clear() const {
    double gain = 0.0, area = 0.0;
    for (const PlacedImprint& one : placed) gain += one.gain, area += std::pow(one.imprint.width(), 2.0);
    return area > 0.0 ? explained * std::pow(gain / area, 2.0) : 0.0;
  }
};

Tried try_scale(SurfaceLevels& surface, const WedgeScale& scale, int rounds) {
  const PatchCells& cells = surface.for_width(scale.width_mm);
  const double tiles = 1.5 * cells.area_mm2() / (scale.width_mm * scale.width_mm);
  const int skip = std::max(1, static_cast<int>(tiles / kScaleTiles));
  std::vector<DeepPlace> places = deep_places(cells, scale, kScaleLeastDepth, skip);  // the deepest first
  const std::size_t every = (places.size() + kScalePlaces - 1) / kScalePlaces;
  for (std::size_t k = 0; k * every < places.size() && every > 1; ++k) places[k] = places[k * every];
  if (every > 1) places.resize((places.size() + every - 1) / every);
  ReliefExplanation relief(surface, scale, places);
  relief.explain(rounds, kScaleCost);
  Tried out{scale, 0.0, relief.placed()};
  for (const PlacedImprint& one : out.placed) out.explained += one.gain;
  out.explained *= scale.width_mm * scale.width_mm * skip * static_cast<double>(std::max<std::size_t>(1, every));
  return out;
}

WedgeScale usual_of(const Tried& tried) {
  std::vector<double> widths, depths;
  for (const PlacedImprint& one : tried.placed) {
    widths.push_back(one.imprint.width() * tried.scale.width_mm);
    depths.push_back(one.imprint.depth() * tried.scale.width_mm);
  }
  return {median(widths), median(depths)};
}

}  // namespace

WedgeScale wedge_scale(SurfaceLevels& surface, double width_mm) {
  const glm::dvec3 e = surface.fine().extent_mm();
  const double shortest = std::min({e.x, e.y, e.z});
  const double root = std::sqrt(e.x * e.y * e.z / std::max(shortest, 1e-12));
  Tried best;
  for (int size = 0; size < (width_mm > 0.0 ? 1 : kScaleSizes); ++size) {
    const double width = width_mm > 0.0 ? width_mm : root / kScaleFinest * std::exp2(size);
    if (!(width_mm > 0.0) && width < kScaleFewestEdges * surface.fine().mean_edge_mm()) continue;
    Tried tried = try_scale(surface, {width, kScaleDepth * width}, 0);
    if (size == 0 || tried.clear() > best.clear()) best = std::move(tried);
  }
  if (best.placed.size() < kScaleFewest) return {};
  double fixed = width_mm;  // whoever says so knows
  const auto usual_now = [&] {
    WedgeScale usual = usual_of(best);
    if (fixed > 0.0) usual.width_mm = fixed;
    return usual;
  };
  Tried better = try_scale(surface, usual_now(), 1);
  if (!(fixed > 0.0) && better.clear() < kScaleAsClear * best.clear()) {
    fixed = best.scale.width_mm;
    better = try_scale(surface, usual_now(), 1);
  }
  best = std::move(better);
  if (best.placed.size() < kScaleFewest) return {};
  const WedgeScale usual = usual_now();
  best = Tried{};
  for (const double rounding : kScaleRoundings) {
    WedgeScale round = usual;
    round.rounding = rounding;
    Tried tried = try_scale(surface, round, 1);
    if (tried.explained > best.explained) best = std::move(tried);
  }
  if (best.placed.size() < kScaleFewest) return {};
  WedgeScale out = usual_now();
  out.rounding = best.scale.rounding * usual.width_mm / out.width_mm;
  return out;
}

}  // namespace dubsar
