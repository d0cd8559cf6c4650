#include "core/filter/edge_spread.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr int kRadius = 5, kInnerRadius = 3;  ///< of the balls, voxels
constexpr std::int64_t kMostGroups = 16, kMostCloseGroups = 128, kGroupSlices = 2 * std::int64_t{kRadius} + 2;
constexpr double kBin = 0.25;  ///< of the distance from the plane, voxels
constexpr int kBins = 10;      ///< they end where the sides have their own density
constexpr std::size_t kTwoSides = 2 * std::size_t{kBins};
constexpr double kCylinder = 2.0;
constexpr double kBeyondBlur = 2.5;  ///< voxels from the plane at which its sides have their own density
constexpr double kLevelError = 0.15, kMostBend = 0.15, kMostTilt = 0.3;
constexpr int kFolds = 16;  ///< parts of the places, each of which gives a variance
constexpr int kLeastPlaces = 200, kFewPlaces = 1000;
/// Uncertainties that a variance is above nothing, and what the extent of a voxel alone makes: below, it says nothing.
constexpr double kSignificant = 2.0, kLeastVariance = 1.0 / 12.0;

struct Offset {
  int x, y, z;
  double length2;
};
std::vector<Offset> ball() {
  std::vector<Offset> offsets;
  for (int z = -kRadius; z <= kRadius; ++z)
    for (int y = -kRadius; y <= kRadius; ++y)
      for (int x = -kRadius; x <= kRadius; ++x)
        if (const int square = x * x + y * y + z * z; square <= kRadius * kRadius)
          offsets.push_back({x, y, z, static_cast<double>(square)});
  return offsets;
}

/// Distance from the middle of a ball of this volume, towards air, of the plane below which `share` of it lies.
double plane_at(double share, double voxels) {
  const double radius = std::cbrt(voxels * 3.0 / (4.0 * M_PI));
  double u = 0.0;  // share = (2 + 3 u - u^3) / 4
  for (int i = 0; i < 6; ++i) u += (4.0 * share - 2.0 - 3.0 * u + u * u * u) / std::max(3.0 * (1.0 - u * u), 0.3);
  return radius * std::clamp(u, -1.0, 1.0);
}

/// Of a normal along an axis: less is across it, more is along it.
constexpr double kAcross = 0.35, kAlong = 0.85;
constexpr int kLeastDoubled = 100;  ///< places along an axis and across it, so that something can be said of both
constexpr double kLeastValley = 0.12, kSureValley = 5.0;  ///< in uncertainties

/// Shares of material by distance from the plane.
struct Profile {
  std::array<double, kTwoSides> sum{}, count{};
  int places = 0;

  void add(const Profile& more) {
    for (std::size_t b = 0; b < kTwoSides; ++b) {
      sum[b] += more.sum[b];
      count[b] += more.count[b];
    }
    places += more.places;
  }
  /// Mean of the slopes `bins` to either side of the middle.
  double slope(int bins) const {
    const auto share = [&](int b) {
      return sum[static_cast<std::size_t>(b)] / std::max(count[static_cast<std::size_t>(b)], 1.0);
    };
    const auto between = [&](int b) { return (share(kBins + b - 1) - share(kBins + b)) / kBin; };
    return 0.5 * (between(-bins) + between(bins));
  }
  double middle_slope() const { return (slope(0) + 2.0 * slope(1)) / 3.0; }
};

/// What the flat places of one fold say, by distance from the plane.
struct Spread : Profile {
  std::array<Profile, 3> across, along;  ///< an axis
  std::vector<double> halves_apart;      ///< of each place: how far apart two halves of it put the plane

  double variance() const {
    double twice = 0.0;
    for (int b = 0; b < 2 * kBins; ++b) {
      const auto i = static_cast<std::size_t>(b);
      if (count[i] == 0.0) continue;
      const double at = kBin * (b + 0.5 - kBins), share = sum[i] / count[i];  // of material; it lies at at < 0
      twice += kBin * std::abs(at) * (at < 0.0 ? 1.0 - share : share);
    }
    return 2.0 * twice;
  }
};
using Folds = std::array<Spread, kFolds>;

class Group {
 public:
  Group(const std::vector<float>& voxels, const Dims& dims, double air, double material)
      : voxels_(voxels), dims_(dims), air_(air), contrast_(material - air) {}

  /// Is there an edge close by, as far as single voxels say?
  bool candidate(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const double middle = air_ + 0.5 * contrast_, here = at(x, y, z) - middle;
    return here * (at(x + 2, y, z) - middle) < 0.0 || here * (at(x, y + 2, z) - middle) < 0.0 ||
           here * (at(x, y, z + 2) - middle) < 0.0 || std::abs(here) < 0.2 * std::abs(contrast_);
  }

  void look(std::int64_t x, std::int64_t y, std::int64_t z, Spread& spread) const {
    static const std::vector<Offset> ball_offsets = ball();
    glm::dvec3 slope(0.0);
    double sum = 0.0, inner = 0.0, inner_count = 0.0;
    for (const Offset& o : ball_offsets) {
      const double v = (at(x + o.x, y + o.y, z + o.z) - air_) / contrast_;
      sum += v;
      slope += v * glm::dvec3(o.x, o.y, o.z);
      if (o.length2 <= kInnerRadius * kInnerRadius) {
        inner += v;
        ++inner_count;
      }
    }
    const auto all = static_cast<double>(ball_offsets.size());
    // A half-space through the middle has 3/16 of the radius times the volume.
    if (glm::length(slope) < 0.6 * all * 3.0 / 16.0 * kRadius) return;
    const glm::dvec3 normal = -glm::normalize(slope);  // towards air
    const double rough = plane_at(sum / all, all);
    if (std::abs(rough) > 1.0) return;
    // The densities of both sides as they are here.
    std::array<double, 2> level{}, level_count{};
    for (const Offset& o : ball_offsets) {
      const double d = glm::dot(normal, glm::dvec3(o.x, o.y, o.z)) - rough;
      if (std::abs(d) < kBeyondBlur) continue;
      level[d > 0.0] += (at(x + o.x, y + o.y, z + o.z) - air_) / contrast_;
      ++level_count[d > 0.0];
    }
    if (level_count[0] < 20.0 || level_count[1] < 20.0) return;
    const double clay = level[0] / level_count[0], empty = level[1] / level_count[1];
    if (std::abs(clay - 1.0) > kLevelError || std::abs(empty) > kLevelError) return;
    const auto share = [&](double s, double n) { return (s / n - empty) / (clay - empty); };
    const double plane = plane_at(share(sum, all), all);
    // A sphere bulges: the plane of a smaller ball is another one. A tilt or a step shows in the halves of the ball.
    if (std::abs(plane_at(share(inner, inner_count), inner_count) - plane) > kMostBend) return;
    const glm::dvec3 along =
        glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    std::array<glm::dvec3, 2> ways{along, glm::cross(normal, along)};
    std::array<double, 2> apart{};
    for (std::size_t w = 0; w < 2; ++w) {
      std::array<double, 2> half{}, count{};
      for (const Offset& o : ball_offsets) {
        const double side = glm::dot(ways[w], glm::dvec3(o.x, o.y, o.z));
        if (std::abs(side) < 1e-9) continue;
        half[side > 0.0] += (at(x + o.x, y + o.y, z + o.z) - air_) / contrast_;
        ++count[side > 0.0];
      }
      apart[w] = plane_at(share(half[0], count[0]), all) - plane_at(share(half[1], count[1]), all);
      if (std::abs(apart[w]) > kMostTilt) return;
    }
    spread.halves_apart.push_back(apart[0]);
    spread.halves_apart.push_back(apart[1]);
    Profile here;
    here.places = 1;
    for (const Offset& o : ball_offsets) {
      const glm::dvec3 q(o.x, o.y, o.z);
      const double across = glm::dot(normal, q), d = across - plane;
      if (o.length2 - across * across > kCylinder * kCylinder) continue;
      const int bin = static_cast<int>(std::floor(d / kBin)) + kBins;
      if (bin < 0 || bin >= 2 * kBins) continue;
      const double v = (at(x + o.x, y + o.y, z + o.z) - air_) / contrast_;
      here.sum[static_cast<std::size_t>(bin)] += (v - empty) / (clay - empty);
      ++here.count[static_cast<std::size_t>(bin)];
    }
    spread.add(here);
    for (std::size_t a = 0; a < 3; ++a) {
      const double part = std::abs(normal[static_cast<int>(a)]);
      if (part < kAcross) spread.across[a].add(here);
      if (part > kAlong) spread.along[a].add(here);
    }
  }

 private:
  double at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return static_cast<double>(voxels_[static_cast<std::size_t>(z * dims_.slice() + y * dims_.x + x)]);
  }
  const std::vector<float>& voxels_;
  Dims dims_;
  double air_, contrast_;
};

Folds merge(Folds all, const Folds& more) {
  for (std::size_t f = 0; f < all.size(); ++f) {
    all[f].add(more[f]);
    for (std::size_t a = 0; a < 3; ++a) {
      all[f].across[a].add(more[f].across[a]);
      all[f].along[a].add(more[f].along[a]);
    }
    all[f].halves_apart.insert(all[f].halves_apart.end(), more[f].halves_apart.begin(), more[f].halves_apart.end());
  }
  return all;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int places_of(const Folds& folds) {
  int places = 0;
  for (const Spread& fold : folds) places += fold.places;
  return places;
}

/// Whether places across the axis rise in two steps and those along it do not.
std::optional<DoubleEdge> double_edge(const Folds& folds, std::size_t axis) {
  Profile across, along;
  for (const Spread& fold : folds) {
    across.add(fold.across[axis]);
    along.add(fold.along[axis]);
  }
  if (across.places < kLeastDoubled || along.places < kLeastDoubled) return std::nullopt;
  int step = 2;
  for (int b = 3; b < kBins; ++b) step = across.slope(b) > across.slope(step) ? b : step;
  DoubleEdge found{static_cast<int>(axis), 2.0 * kBin * step, 1.0 - across.middle_slope() / across.slope(step)};
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const Spread& fold : folds) {
    const Profile& some = fold.across[axis];
    if (some.places < kLeastDoubled / kFolds) continue;
    const double valley = some.slope(step) - some.middle_slope();
    sum += valley;
    squares += valley * valley;
    ++count;
  }
  const double error =
      std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)) / std::max(count - 1.0, 1.0));
  if (count < 3.0 || found.valley < kLeastValley || sum / count < kSureValley * error) return std::nullopt;
  if (along.middle_slope() < along.slope(step)) return std::nullopt;  // two layers, whichever way they lie
  return found;
}

std::optional<EdgeSpread> summary(const Folds& folds) {
  EdgeSpread result;
  result.places = places_of(folds);
  std::vector<double> variances, apart;
  Spread whole;
  for (const Spread& fold : folds) {
    if (fold.places == 0) continue;
    whole.add(fold);
    variances.push_back(fold.variance());
    for (const double way : fold.halves_apart) apart.push_back(std::abs(way));
  }
  if (result.places < kLeastPlaces) return std::nullopt;
  // Planes are put a little wrong by the noise, and halves by twice as much: that is no blur.
  const double off = 0.5 * 1.4826 * median(std::move(apart));
  const double middle = median(variances);
  for (double& v : variances) v = std::abs(v - middle);
  const auto count = static_cast<double>(variances.size());
  result.uncertainty = 1.4826 * median(std::move(variances)) / std::sqrt(count);
  // Of all places at once: that of the folds' median scatters by twice as much with where they lie on the grid.
  result.variance = whole.variance() - off * off;
  if (result.variance <= std::max(kLeastVariance, kSignificant * result.uncertainty)) return std::nullopt;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const auto doubled = double_edge(folds, axis);
        doubled && (!result.doubled || doubled->valley > result.doubled->valley))
      result.doubled = doubled;
  return result;
}

/// Looks at every second voxel of every second row of the middle slices of the groups that begin at `firsts`.
Result<Folds> look_at(SlabSource& source, std::span<const std::int64_t> firsts, double air, double material,
                      Progress& progress) {
  constexpr std::int64_t kStride = 2;
  const Dims d = source.dims();
  std::vector<float> voxels(static_cast<std::size_t>(kGroupSlices * d.slice()));
  const std::int64_t rows = (d.y - kGroupSlices) / kStride, columns = (d.x - kGroupSlices) / kStride;
  Folds all{};
  for (const std::int64_t z0 : firsts) {
    if (progress.cancelled()) return cancelled_error();
    DUBSAR_TRY(source.read(z0, z0 + kGroupSlices, voxels));
    const Group group(voxels, {d.x, d.y, kGroupSlices}, air, material);
    all = parallel_reduce<Folds>(
        rows, 4, std::move(all),
        [&](std::int64_t begin, std::int64_t end) {
          Folds part{};
          for (std::int64_t row = begin; row < end; ++row)
            for (std::int64_t column = 0; column < columns; ++column) {
              const std::int64_t x = kRadius + kStride * column, y = kRadius + kStride * row, z = kRadius;
              // Neighbouring places share voxels: a fold is a coarse field of them, so that folds do not.
              const auto fold = static_cast<std::size_t>((x / 16 + 4 * (y / 16) + 5 * (z0 / kGroupSlices)) % kFolds);
              if (group.candidate(x, y, z)) group.look(x, y, z, part[fold]);
            }
          return part;
        },
        merge);
  }
  return all;
}

/// The first slices of `most` groups or fewer, evenly through the volume, at least `apart` from each other.
std::vector<std::int64_t> groups_through(std::int64_t depth, std::int64_t most, std::int64_t apart) {
  const std::int64_t last = depth - kGroupSlices, count = std::clamp<std::int64_t>(last / apart + 1, 1, most);
  std::vector<std::int64_t> firsts;
  for (std::int64_t i = 0; i < count; ++i) firsts.push_back(count == 1 ? last / 2 : i * last / (count - 1));
  return firsts;
}

}  // namespace

std::string describe(const DoubleEdge& edge) {
  return fmt::format(
      "edges across {0} rise in two steps, about {1:.1f} voxels apart, and those along it in one: the axis of rotation "
      "(along {0}) was some {2:.2f} voxels from where the reconstruction took it, which is not undone; reconstruct the "
      "scan anew with the right axis",
      "xyz"[edge.axis], edge.apart, 0.5 * edge.apart);
}

Result<std::optional<EdgeSpread>> measure_edge_spread(SlabSource& source, double air, double material,
                                                      Progress& progress) {
  const Dims d = source.dims();
  if (!(material > air) || std::min({d.x, d.y, d.z}) <= kGroupSlices) return std::optional<EdgeSpread>{};
  DUBSAR_ASSIGN(Folds folds, look_at(source, groups_through(d.z, kMostGroups, kGroupSlices), air, material, progress));
  if (places_of(folds) < kFewPlaces) {  // a small scan: its slices closer together
    DUBSAR_ASSIGN(folds, look_at(source, groups_through(d.z, kMostCloseGroups, 2), air, material, progress));
  }
  return summary(folds);
}

}  // namespace dubsar
