#include "core/extract/noise_cavities.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel_gather.h"
#include "core/extract/edge_index.h"

namespace dubsar {
namespace {

using Point = std::array<std::int64_t, 3>;  ///< z, y, x
constexpr std::size_t kMostPoints = 64;
constexpr std::int64_t kMostExtent = 6;  ///< of such a cavity along an axis
constexpr std::int64_t kAround = 6;      ///< points around a cavity whose clay it is compared with
constexpr std::int64_t kFringe = 2;      ///< of these, the nearest are blurred with it
constexpr std::size_t kLeastClay = 100;

struct Cavity {
  std::vector<Point> points;  ///< rising
  Point least{}, most{};
};

class Search {
 public:
  explicit Search(const BitVolume& signs) : signs_(signs), dims_(signs.dims()) {}

  /// Small cavities whose first point lies in row (y, z).
  void of_row(std::int64_t y, std::int64_t z, std::vector<Cavity>& found) const {
    const std::uint64_t* row = signs_.row(y, z);
    for (std::int64_t word = 0; word < signs_.words_per_row(); ++word) {
      const std::uint64_t before = row[word] << 1 | (word > 0 ? row[word - 1] >> 63 : 0);
      for (std::uint64_t starts = ~row[word] & before; starts != 0; starts &= starts - 1) {
        const std::int64_t x = 64 * word + std::countr_zero(starts);
        if (x >= dims_.x) break;
        if (reaches_far({z, y, x})) continue;
        if (Cavity cavity; flood({z, y, x}, cavity)) found.push_back(std::move(cavity));
      }
    }
  }

 private:
  bool air(const Point& p) const { return !signs_.get(p[2], p[1], p[0]); }
  bool at_border(const Point& p) const {
    return p[0] <= 0 || p[1] <= 0 || p[2] <= 0 || p[0] >= dims_.z - 1 || p[1] >= dims_.y - 1 || p[2] >= dims_.x - 1;
  }
  /// Along one of the axes, as nearly every place at a large surface does.
  bool reaches_far(const Point& from) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::int64_t run = 1;
      for (const std::int64_t step : {-1, 1}) {
        Point p = from;
        for (; run <= kMostExtent; ++run) {
          if (at_border(p)) return true;
          p[axis] += step;
          if (!air(p)) break;
        }
      }
      if (run > kMostExtent) return true;
    }
    return false;
  }
  /// All air that hangs together with `from` through faces, and across faces where the surface may connect it. False
  /// where it is large, touches the border, or does not begin with `from`.
  bool flood(const Point& from, Cavity& cavity) const {
    std::set<Point> seen{from};
    std::vector<Point> queue{from};
    cavity.least = cavity.most = from;
    while (!queue.empty()) {
      const Point p = queue.back();
      queue.pop_back();
      if (at_border(p)) return false;
      for (std::int64_t k = 0; k < 27; ++k) {
        const Point step{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
        if (std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]) > 2) continue;
        const Point q{p[0] + step[0], p[1] + step[1], p[2] + step[2]};
        if (!air(q) || !seen.insert(q).second) continue;
        if (q < from || seen.size() > kMostPoints) return false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          cavity.least[axis] = std::min(cavity.least[axis], q[axis]);
          cavity.most[axis] = std::max(cavity.most[axis], q[axis]);
          if (cavity.most[axis] - cavity.least[axis] >= kMostExtent) return false;
        }
        queue.push_back(q);
      }
    }
    cavity.points.assign(seen.begin(), seen.end());
    return true;
  }

  const BitVolume& signs_;
  Dims dims_;
};

/// Slices of a source, as many as a cavity needs.
struct Slices {
  std::int64_t begin = 0, end = 0;
  std::vector<float> values;
};

/// A source may stand constants where it has nothing (core/refine): they have no noise.
void leave_out_constants(std::vector<float>& values) {
  constexpr std::ptrdiff_t kMostEqual = 8;
  std::sort(values.begin(), values.end());
  auto to = values.begin();
  for (auto from = values.begin(); from != values.end();) {
    const auto end = std::upper_bound(from, values.end(), *from);
    if (end - from <= kMostEqual) to = std::move(from, end, to);
    from = end;
  }
  values.erase(to, values.end());
}

/// Is the darkest point of a cavity no more than the noise of the clay around it makes?
bool is_faint(const Cavity& cavity, const SurfaceSamples& samples, const Slices& slices, double deviations) {
  const Dims d = samples.dims;
  const auto value = [&](std::int64_t z, std::int64_t y, std::int64_t x) {
    return slices.values[static_cast<std::size_t>(((z - slices.begin) * d.y + y) * d.x + x)];
  };
  float least = INFINITY;
  for (const Point& p : cavity.points) least = std::min(least, value(p[0], p[1], p[2]));
  std::vector<float> clay;
  Point begin{}, end{};
  const std::array<std::int64_t, 3> size{d.z, d.y, d.x};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    begin[axis] = std::max<std::int64_t>(cavity.least[axis] - kAround, axis == 0 ? slices.begin : 0);
    end[axis] = std::min(cavity.most[axis] + kAround + 1, axis == 0 ? slices.end : size[axis]);
  }
  const auto beside = [&](std::int64_t at, std::size_t axis) {
    return at >= cavity.least[axis] - kFringe && at <= cavity.most[axis] + kFringe;
  };
  for (std::int64_t z = begin[0]; z < end[0]; ++z)
    for (std::int64_t y = begin[1]; y < end[1]; ++y)
      for (std::int64_t x = begin[2]; x < end[2]; ++x)
        if (samples.signs.get(x, y, z) && !(beside(z, 0) && beside(y, 1) && beside(x, 2)))
          clay.push_back(value(z, y, x));
  leave_out_constants(clay);
  if (clay.size() < kLeastClay) return false;
  const float middle = median(clay);
  for (float& v : clay) v = std::abs(v - middle);
  const float noise = 1.4826f * median(std::move(clay));
  return least >= middle - static_cast<float>(deviations) * noise;
}

/// Items of the rows beside the points that are no more once these are clay: numbers of active edges and ambiguous
/// faces, rising.
struct Gone {
  std::vector<std::uint32_t> edges, faces;
};
Gone gone_with(const std::vector<Point>& points, const SurfaceSamples& samples, const EdgeIndex& index) {
  const BitVolume& signs = samples.signs;
  const Dims d = samples.dims;
  const std::set<Point> filled(points.begin(), points.end());
  std::set<std::pair<std::int64_t, std::int64_t>> rows;  // z, y
  for (const Point& p : points)
    for (const std::int64_t z : {p[0] - 1, p[0]})
      for (const std::int64_t y : {p[1] - 1, p[1]}) rows.insert({z, y});
  Gone gone;
  for (const auto& [z, y] : rows) {
    const RowStarts starts = index.starts(y, z);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const glm::ivec3 along{axis == 0, axis == 1, axis == 2};
      const glm::ivec3 u{axis != 0, axis == 0, 0}, v{0, axis == 2, axis != 2};
      std::uint32_t edge = starts.edges[a], face = starts.faces[a];
      for (std::int64_t x = 0; x < d.x; ++x) {
        const auto in_grid = [&](const glm::ivec3& step) {
          return x + step.x < d.x && y + step.y < d.y && z + step.z < d.z;
        };
        const auto inside = [&](const glm::ivec3& step) { return signs.get(x + step.x, y + step.y, z + step.z); };
        const auto fills = [&](const glm::ivec3& step) {
          return filled.contains({z + step.z, y + step.y, x + step.x});
        };
        const glm::ivec3 here(0);
        if (in_grid(along) && inside(here) != inside(along)) {
          if (fills(here) || fills(along)) gone.edges.push_back(edge);
          ++edge;
        }
        if (in_grid(u + v) && inside(here) == inside(u + v) && inside(u) == inside(v) && inside(here) != inside(u)) {
          if (fills(here) || fills(u) || fills(v) || fills(u + v)) gone.faces.push_back(face);
          ++face;
        }
      }
    }
  }
  std::sort(gone.edges.begin(), gone.edges.end());
  std::sort(gone.faces.begin(), gone.faces.end());
  return gone;
}

/// Removes the items with these rising numbers.
template <class T>
void erase(std::vector<T>& items, const std::vector<std::uint32_t>& numbers) {
  if (numbers.empty()) return;
  std::size_t to = numbers.front();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const std::size_t from = std::size_t{numbers[k]} + 1, end = k + 1 < numbers.size() ? numbers[k + 1] : items.size();
    to = static_cast<std::size_t>(std::move(items.begin() + static_cast<std::ptrdiff_t>(from),
                                            items.begin() + static_cast<std::ptrdiff_t>(end),
                                            items.begin() + static_cast<std::ptrdiff_t>(to)) -
                                  items.begin());
  }
  items.resize(to);
}

}  // namespace

Result<NoiseCavities> fill_noise_cavities(SurfaceSamples& samples, SlabSource& source, const CavityRule& rule,
                                          Progress& progress) {
  const Dims d = samples.dims;
  const Search search(samples.signs);
  const std::vector<Cavity> found =
      parallel_gather<Cavity>(d.y * d.z, 64, [&](std::int64_t begin, std::int64_t end, std::vector<Cavity>& some) {
        for (std::int64_t row = begin; row < end; ++row) search.of_row(row % d.y, row / d.y, some);
      });
  const double diameter = rule.deviations_across * rule.blur_vox;
  const double least_points = std::numbers::pi / 6.0 * diameter * diameter * diameter;
  NoiseCavities result;
  std::vector<Point> points;
  Slices slices;
  for (const Cavity& cavity : found) {  // in rising order of their first slices
    bool noise = static_cast<double>(cavity.points.size()) < least_points;
    if (!noise) {
      if (progress.cancelled()) return cancelled_error();
      const std::int64_t begin = std::max<std::int64_t>(cavity.least[0] - kAround, 0),
                         end = std::min(cavity.most[0] + kAround + 1, d.z);
      if (begin < slices.begin || end > slices.end) {
        slices.begin = begin;
        slices.end = std::min(begin + 4 * kAround, d.z);
        slices.values.resize(static_cast<std::size_t>((slices.end - slices.begin) * d.slice()));
        DUBSAR_TRY(source.read(slices.begin, slices.end, slices.values));
      }
      noise = is_faint(cavity, samples, slices, rule.noise_deviations);
    }
    if (!noise) continue;
    ++result.cavities;
    result.points += static_cast<std::int64_t>(cavity.points.size());
    points.insert(points.end(), cavity.points.begin(), cavity.points.end());
  }
  if (points.empty()) return result;
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(samples));
  const Gone gone = gone_with(points, samples, index);
  for (const Point& p : points) samples.signs.set(p[2], p[1], p[0], true);
  erase(samples.offsets, gone.edges);
  erase(samples.joined, gone.faces);
  return result;
}

}  // namespace dubsar
