#include "core/script/wedge_width.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/numbers/median.h"
#include "core/script/explain_relief.h"

namespace dubsar {
namespace {

constexpr int kScaleSizes = 4;
constexpr double kScaleFinest = 100.0;     // of the root of the two longest extents' product, the least width
constexpr double kScaleFewestEdges = 2.0;  // over a width
constexpr double kScaleGap = 1.3;          // of that: then it is tried, too
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
// Edges over a width: where there are fewer, a surface of few triangles is looked at in several attitudes. Of S264's
// roundings .15 and .30 explain alike in one of them (2 % apart), and 55 or 61 of 81 heads are found with them.
constexpr double kScaleCoarse = 6.0;
constexpr std::size_t kScaleTurns = 5;

/// A surface, and turned: where heads are few edges wide, tiles and samples that lie otherwise see others of them.
class ScaleAttitudes {
 public:
  explicit ScaleAttitudes(SurfaceLevels& own) : own_(own) {}
  std::vector<SurfaceLevels*> of_width(double width_mm) {
    std::vector<SurfaceLevels*> out{&own_};
    if (width_mm > kScaleCoarse * own_.fine().mean_edge_mm() || own_.fine().triangles().size() > kCoarseTriangles)
      return out;
    for (std::size_t k = 0; k < kScaleTurns; ++k) {
      if (turned_.size() == k) turned_.push_back(std::make_unique<SurfaceLevels>(turned(k)));
      out.push_back(turned_[k].get());
    }
    return out;
  }

 private:
  PatchCells turned(std::size_t k) const {
    // Spread over the turns of space: uniform quaternions (Shoemake, 1992) of Roberts's sequence R3.
    const double n = static_cast<double>(k + 1), a = std::fmod(0.5 + 0.8191725 * n, 1.0),
                 b = std::fmod(0.5 + 0.6710436 * n, 1.0), c = std::fmod(0.5 + 0.5497005 * n, 1.0),
                 pi2 = 2.0 * std::numbers::pi;
    const glm::dquat q(std::sqrt(a) * std::cos(pi2 * c), std::sqrt(1.0 - a) * std::sin(pi2 * b),
                       std::sqrt(1.0 - a) * std::cos(pi2 * b), std::sqrt(a) * std::sin(pi2 * c));
    const glm::mat3 turn(glm::mat3_cast(q));
    std::vector<glm::vec3> points = own_.fine().points();
    for (glm::vec3& p : points) p = turn * p;
    return {std::move(points), own_.fine().triangles()};
  }
  SurfaceLevels& own_;
  std::vector<std::unique_ptr<SurfaceLevels>> turned_;
};

struct Tried {
  WedgeScale scale;
  double explained = 0.0;             // gain times area
  std::vector<PlacedImprint> placed;  // on all attitudes together
  std::size_t attitudes = 1;

  bool few() const { return placed.size() < kScaleFewest * attitudes; }

  /// What is explained, and how well where it is: gain over the area of heads, which has no unit and is most where the
  /// model is neither wider nor narrower than what was pressed.
  double clear() const {
    double gain = 0.0, area = 0.0;
    for (const PlacedImprint& one : placed) gain += one.gain, area += std::pow(one.imprint.width(), 2.0);
    return area > 0.0 ? explained * std::pow(gain / area, 2.0) : 0.0;
  }
};

void try_attitude(SurfaceLevels& surface, const WedgeScale& scale, int rounds, Tried& out) {
  const PatchCells& cells = surface.for_width(scale.width_mm);
  const double tiles = 1.5 * cells.area_mm2() / (scale.width_mm * scale.width_mm);
  const int skip = std::max(1, static_cast<int>(tiles / kScaleTiles));
  std::vector<DeepPlace> places = deep_places(cells, scale, kScaleLeastDepth, skip);  // the deepest first
  const std::size_t every = (places.size() + kScalePlaces - 1) / kScalePlaces;
  for (std::size_t k = 0; k * every < places.size() && every > 1; ++k) places[k] = places[k * every];
  if (every > 1) places.resize((places.size() + every - 1) / every);
  ReliefExplanation relief(surface, scale, places);
  relief.explain(rounds, kScaleCost);
  double gain = 0.0;
  for (const PlacedImprint& one : relief.placed()) {
    gain += one.gain;
    out.placed.push_back(one);
  }
  out.explained += gain * scale.width_mm * scale.width_mm * skip * static_cast<double>(std::max<std::size_t>(1, every));
}

Tried try_scale(ScaleAttitudes& attitudes, const WedgeScale& scale, int rounds) {
  Tried out;
  out.scale = scale;
  const std::vector<SurfaceLevels*> seen = attitudes.of_width(scale.width_mm);
  for (SurfaceLevels* surface : seen) try_attitude(*surface, scale, rounds, out);
  out.attitudes = seen.size();
  out.explained /= static_cast<double>(out.attitudes);
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
  ScaleAttitudes attitudes(surface);
  Tried best;
  std::vector<double> sizes;
  const double least = kScaleFewestEdges * surface.fine().mean_edge_mm();
  for (int size = 0; size < kScaleSizes && !(width_mm > 0.0); ++size)
    if (const double width = root / kScaleFinest * std::exp2(size); width >= least) sizes.push_back(width);
  // Octaves of the tablet's size may begin well above what the mesh can show.
  if (width_mm > 0.0)
    sizes.push_back(width_mm);
  else if (sizes.empty() || sizes.front() > kScaleGap * least)
    sizes.insert(sizes.begin(), least);
  for (const double width : sizes) {
    Tried tried = try_scale(attitudes, {width, kScaleDepth * width}, 0);
    if (width == sizes.front() || tried.clear() > best.clear()) best = std::move(tried);
  }
  if (best.few()) return {};
  double fixed = width_mm;  // whoever says so knows
  const auto usual_now = [&] {
    WedgeScale usual = usual_of(best);
    if (fixed > 0.0) usual.width_mm = fixed;
    return usual;
  };
  Tried better = try_scale(attitudes, usual_now(), 1);
  if (!(fixed > 0.0) && better.clear() < kScaleAsClear * best.clear()) {
    fixed = best.scale.width_mm;
    better = try_scale(attitudes, usual_now(), 1);
  }
  best = std::move(better);
  if (best.few()) return {};
  const WedgeScale usual = usual_now();
  best = Tried{};
  for (const double rounding : kScaleRoundings) {
    WedgeScale round = usual;
    round.rounding = rounding;
    Tried tried = try_scale(attitudes, round, 1);
    if (tried.explained > best.explained) best = std::move(tried);
  }
  if (best.few()) return {};
  WedgeScale out = usual_now();
  out.rounding = best.scale.rounding * usual.width_mm / out.width_mm;
  return out;
}

}  // namespace dubsar
