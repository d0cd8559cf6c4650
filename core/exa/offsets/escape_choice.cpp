#include "core/exa/offsets/escape_choice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "core/base/system/parallel_gather.h"
#include "core/exa/values/exact.h"
#include "core/extract/cell_box.h"

namespace dubsar {
namespace {
constexpr std::int64_t kEscapeGrain = 1 << 13;
constexpr double kOutsideHalf = 0.045;                   // vertices that may lie further than half the bound
constexpr double kAlong = 0.4;                           // least cosine between normal and axis of a short escape
constexpr double kMore = 1.0 + 1e-9, kRounding = 1e-20;  // what is left out is further away for certain

/// From a place to a triangle, or `least` where that is nearer. Most triangles of a fan are found to be further away by
/// the plane or a side that the place lies beyond, before distances to sides have to be known.
double nearer(double least, const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, n = glm::cross(ab, ac);
  const double area = glm::dot(n, n);
  if (area > 0.0) {
    const double height = glm::dot(p - a, n), far = (least * least * kMore + kRounding) * area;
    if (height * height > far) return least;
    bool inside = true, away = false;
    const auto look_beyond = [&](const glm::dvec3& from, const glm::dvec3& to) {
      if (away) return;
      const glm::dvec3 along = to - from;
      const double within = glm::dot(glm::cross(along, p - from), n);
      if (within >= 0.0) return;
      inside = false;
      const double length = glm::dot(along, along);
      away = height * height * length + within * within > far * length;
    };
    look_beyond(a, b);
    look_beyond(b, c);
    look_beyond(c, a);
    if (inside) return std::min(least, std::abs(height) / std::sqrt(area));
    if (away) return least;
  }
  const auto side = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 along = to - from;
    const double length = glm::dot(along, along);
    const double t = length > 0.0 ? std::clamp(glm::dot(p - from, along) / length, 0.0, 1.0) : 0.0;
    return glm::length(p - from - t * along);
  };
  return std::min({least, side(a, b), side(b, c), side(c, a)});
}

/// The corners of an x-quad, and on which side of the two edges at one of its vertices a place lies.
struct QuadAt {
  std::array<glm::dvec3, 8> corner;
  int size;
  glm::dvec3 vertex;
  std::array<glm::dvec3, 2> away;  ///< in the plane of the two edges, across each of them, out of the corner
  std::array<double, 2> beyond;    ///< of the place, along `away`: positive where it lies beyond the edge
};

void look(const QuadMesh& mesh, std::uint32_t v, std::uint32_t q, const glm::dvec3& p, QuadAt& quad) {
  const auto put = [&](const std::uint32_t* vertex, int size) {
    int here = 0;
    for (int i = 0; i < size; ++i) {
      quad.corner[static_cast<std::size_t>(i)] = glm::dvec3(mesh.positions[vertex[i]]);
      if (vertex[i] == v) here = i;
    }
    quad.size = size;
    quad.vertex = quad.corner[static_cast<std::size_t>(here)];
    const glm::dvec3 next = quad.corner[static_cast<std::size_t>(here + 1 < size ? here + 1 : 0)] - quad.vertex,
                     last = quad.corner[static_cast<std::size_t>(here > 0 ? here - 1 : size - 1)] - quad.vertex;
    const double both = glm::dot(next, last);
    quad.away = {next * both - last * glm::dot(next, next), last * both - next * glm::dot(last, last)};
  };
  if (mesh.has_doubled(q)) {
    const Polygon polygon = mesh.polygon(q);
    put(polygon.vertex.data(), polygon.size);
  } else {
    put(mesh.quads[q].data(), 4);
  }
  for (std::size_t k = 0; k < 2; ++k) quad.beyond[k] = glm::dot(quad.away[k], p - quad.vertex);
}

/// A plane between the place and all corners is further away than `least`: so is the x-quad.
bool surely_further(const QuadAt& quad, double least) {
  const double near = least * least * kMore + kRounding;
  for (std::size_t k = 0; k < 2; ++k) {
    double gap = quad.beyond[k];
    if (!(gap > 0.0 && gap * gap > near * glm::dot(quad.away[k], quad.away[k]))) continue;
    for (std::size_t i = 0; i < static_cast<std::size_t>(quad.size); ++i)
      gap = std::min(gap, quad.beyond[k] - glm::dot(quad.away[k], quad.corner[i] - quad.vertex));
    if (gap > 0.0 && gap * gap > near * glm::dot(quad.away[k], quad.away[k])) return true;
  }
  return false;
}

/// From a place to an x-quad that is cut in both ways, or `least` where that is nearer.
double nearer(double least, const glm::dvec3& p, const QuadAt& quad) {
  const auto at = [&](int i) { return quad.corner[static_cast<std::size_t>(i < quad.size ? i : i - quad.size)]; };
  for (int start = 0; start < 2; ++start)
    for (int i = 1; i + 1 < quad.size; ++i) least = nearer(least, p, at(start), at(start + i), at(start + i + 1));
  return least;
}

/// From a place to the x-quads around a vertex, each cut in both ways. Those in whose corner the place lies come first:
/// most of the others are then found to be further away without a look at their triangles.
double distance_to_fan(const QuadMesh& mesh, std::uint32_t v, const glm::dvec3& p) {
  constexpr std::size_t kLater = 8;
  double least = glm::length(p - glm::dvec3(mesh.positions[v]));
  std::array<QuadAt, kLater + 1> quads;
  std::size_t later = 0;
  for (const std::uint32_t q : mesh.quads_of(v)) {
    QuadAt& quad = quads[later];
    look(mesh, v, q, p, quad);
    if (later < kLater && (quad.beyond[0] > 0.0 || quad.beyond[1] > 0.0))
      ++later;
    else
      least = nearer(least, p, quad);
  }
  for (std::size_t i = 0; i < later; ++i)
    if (!surely_further(quads[i], least)) least = nearer(least, p, quads[i]);
  return least;
}

/// The fewest steps along one axis that bring a vertex within `near` of the surface.
std::optional<glm::ivec3> steps_back(const QuadMesh& wanted, std::uint32_t v, const glm::vec3& normal,
                                     const glm::vec3& from, double near) {
  const glm::dvec3 n(normal);
  const double away = glm::dot(n, glm::dvec3(wanted.positions[v]) - glm::dvec3(from));
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return std::abs(n[a]) > std::abs(n[b]); });
  for (const int axis : axes) {
    if (std::abs(n[axis]) < kAlong) break;
    const double step = std::abs(n[axis]) * kEscapeStep;
    const int sign = (away < 0.0) == (n[axis] < 0.0) ? 1 : -1;
    const int first = std::max(1, static_cast<int>(std::ceil((std::abs(away) - near) / step)));
    const int last = static_cast<int>(std::floor((std::abs(away) + near) / step));
    for (int k = first; k <= last; ++k) {
      glm::ivec3 steps(0);
      steps[axis] = sign * k;
      const glm::vec3 place = escaped(from, steps);
      if (wanted.embedded && kept_in_cell(from, place) != place) break;
      if (distance_to_fan(wanted, v, glm::dvec3(place)) <= near) return steps;
    }
  }
  return std::nullopt;
}

/// Numbers that are not negative, by rank; all threads.
class Ranking {
 public:
  explicit Ranking(std::span<const float> values) : values_(values) {
    counts_ = parallel_reduce<std::vector<std::int64_t>>(
        static_cast<std::int64_t>(values.size()), kRankGrain, std::vector<std::int64_t>(kBuckets),
        [&](std::int64_t begin, std::int64_t end) {
          std::vector<std::int64_t> part(kBuckets);
          for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            ++part[bucket(values_[i])];
          return part;
        },
        [](std::vector<std::int64_t> all, const std::vector<std::int64_t>& part) {
          for (std::size_t k = 0; k < kBuckets; ++k) all[k] += part[k];
          return all;
        });
  }
  /// The value at `place` in rising order.
  float at(std::size_t place) const {
    auto left = static_cast<std::int64_t>(place);
    std::size_t own = 0;
    while (left >= counts_[own]) left -= counts_[own++];
    auto inside =
        parallel_gather<float>(static_cast<std::int64_t>(values_.size()), kRankGrain,
                               [&](std::int64_t begin, std::int64_t end, std::vector<float>& part) {
                                 for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                                   if (bucket(values_[i]) == own) part.push_back(values_[i]);
                               });
    std::nth_element(inside.begin(), inside.begin() + left, inside.end());
    return inside[static_cast<std::size_t>(left)];
  }

 private:
  static constexpr std::int64_t kRankGrain = 1 << 20;
  static constexpr int kShift = 18;  // sign, exponent and 5 bits behind the point: 32 buckets between 2^k and 2^(k+1)
  static constexpr std::size_t kBuckets = std::size_t{1} << (32 - kShift);
  static std::size_t bucket(float value) { return std::bit_cast<std::uint32_t>(value) >> kShift; }
  std::span<const float> values_;
  std::vector<std::int64_t> counts_;
};

}  // namespace

void let_escape(const QuadMesh& wanted, std::span<const glm::vec3> normals, double bound,
                std::vector<glm::vec3>& positions, SettleStats& stats) {
  if (positions.empty()) return;
  std::vector<float> error(positions.size());
  parallel_for(static_cast<std::int64_t>(positions.size()), kEscapeGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    error[v] = static_cast<float>(distance_to_fan(wanted, static_cast<std::uint32_t>(v), glm::dvec3(positions[v])));
  });
  const auto kept = static_cast<std::size_t>((1.0 - kOutsideHalf) * static_cast<double>(error.size()));
  double limit = bound;
  if (const Ranking ranked(error); kept < error.size() && ranked.at(kept) > 0.5 * bound) {
    // The worst go first: those left between half the bound and the limit are few enough.
    const auto half = static_cast<float>(0.5 * bound);
    const auto within =
        static_cast<std::size_t>(std::count_if(error.begin(), error.end(), [&](float e) { return !(half < e); }));
    const auto spare = static_cast<std::size_t>(kOutsideHalf * static_cast<double>(error.size()));
    limit = std::min<double>(bound, within + spare < error.size() ? ranked.at(within + spare) : bound);
  }
  std::vector<std::uint8_t> gone(positions.size(), 0);
  parallel_for(static_cast<std::int64_t>(positions.size()), kEscapeGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    if (!(error[v] > limit)) return;
    auto k = steps_back(wanted, static_cast<std::uint32_t>(v), normals[v], positions[v], 0.5 * bound);
    const glm::vec3& own = wanted.positions[v];
    if (!k) k = escape_to(positions[v], wanted.embedded ? kept_in_cell(positions[v], own) : own);
    if (!k) return;
    positions[v] = escaped(positions[v], *k);
    error[v] = static_cast<float>(distance_to_fan(wanted, static_cast<std::uint32_t>(v), glm::dvec3(positions[v])));
    gone[v] = 1;
  });
  const auto count = static_cast<double>(error.size());
  stats.escaped_fraction = static_cast<double>(std::count(gone.begin(), gone.end(), 1)) / count;
  double sum = 0.0;
  for (const float e : error) sum += e;
  stats.mean_error_vox = sum / count;
  stats.p95_error_vox = Ranking(error).at(error.size() * 95 / 100);
  stats.max_error_vox = *std::max_element(error.begin(), error.end());
}

}  // namespace dubsar
