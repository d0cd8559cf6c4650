#include "core/mesh/writing/body_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kGrain = 1 << 16;
constexpr double kUpright = 0.75;   // squared sine of the angle to the broad side: 60 degrees
constexpr double kFourFold = 0.03;  // of the edges' area: less is a round tablet

/// Eigenvectors of a symmetric matrix as columns, by falling eigenvalue: cyclic Jacobi rotations.
glm::dmat3 eigenvectors(glm::dmat3 m) {
  glm::dmat3 v(1.0);
  for (int sweep = 0; sweep < 32; ++sweep)
    for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (std::abs(m[q][p]) < 1e-300) continue;
      const double theta = (m[q][q] - m[p][p]) / (2.0 * m[q][p]);
      const double t = (theta >= 0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
      const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
      glm::dmat3 turn(1.0);
      turn[p][p] = turn[q][q] = c;
      turn[q][p] = s;
      turn[p][q] = -s;
      m = glm::transpose(turn) * m * turn;
      v = v * turn;
    }
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return m[a][a] > m[b][b]; });
  return {v[order[0]], v[order[1]], v[order[2]]};
}

/// Calls with the normal times twice the area, and that length, of each triangle that has one; sums in a fixed order.
template <class Sum, class Add>
Sum over_faces(std::span<const glm::dvec3> points, std::span<const Triangle> triangles, const Add& add) {
  return parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), kGrain, Sum{},
      [&](std::int64_t begin, std::int64_t end) {
        Sum part;
        for (const Triangle& t :
             triangles.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin))) {
          const glm::dvec3 n = glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
          const double area = glm::length(n);
          if (area > 0.0 && std::isfinite(area)) add(part, n, area);
        }
        return part;
      },
      [](Sum one, const Sum& other) {
        one += other;
        return one;
      });
}

struct Directions {
  std::complex<double> sum = 0.0;
  double all = 0.0;
  void operator+=(const Directions& other) {
    sum += other.sum;
    all += other.all;
  }
};

struct Areas {
  glm::dmat3 sum{0.0};
  void operator+=(const Areas& other) { sum += other.sum; }
};

/// Which way the edges of the broad side look: they repeat by quarters of a turn.
glm::dmat3 along_the_edges(const glm::dmat3& axes, std::span<const glm::dvec3> points,
                           std::span<const Triangle> triangles) {
  const auto [sum, all] =
      over_faces<Directions>(points, triangles, [&](Directions& part, const glm::dvec3& n, double area) {
        const std::complex<double> direction(glm::dot(n, axes[1]) / area, glm::dot(n, axes[2]) / area);
        if (std::norm(direction) < kUpright) return;  // of the broad sides, or the wall of an impression
        const std::complex<double> square = direction * direction;
        part.sum += area * square * square;
        part.all += area;
      });
  if (std::abs(sum) < kFourFold * all) return axes;
  const double turn = std::arg(sum) / 4.0;
  return {axes[0], std::cos(turn) * axes[1] + std::sin(turn) * axes[2],
          std::cos(turn) * axes[2] - std::sin(turn) * axes[1]};
}

/// The same direction or its opposite, whichever looks along the axis it is nearest to.
glm::dvec3 along_its_axis(const glm::dvec3& v) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(v[k]) > std::abs(v[axis]) + 1e-9) axis = k;
  return v[axis] < 0 ? -v : v;
}

}  // namespace

Result<BodyAxes> body_axes(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles) {
  const Areas areas = over_faces<Areas>(points_mm, triangles, [](Areas& part, const glm::dvec3& n, double area) {
    part.sum += glm::outerProduct(n, n / area);
  });
  if (!(areas.sum[0][0] + areas.sum[1][1] + areas.sum[2][2] > 0.0))
    return fail(ErrorKind::kBadData, "the surface has no area, expected a tablet that can be turned upright");
  const glm::dmat3 found = along_the_edges(eigenvectors(areas.sum), points_mm, triangles);
  BodyAxes out;
  out.axes[0] = along_its_axis(found[0]);
  out.axes[1] = along_its_axis(found[1]);
  out.axes[2] = glm::cross(out.axes[0], out.axes[1]);
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) {
      const glm::dvec3 p = glm::transpose(out.axes) * points_mm[v];
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  out.extent = high - low;
  return out;
}

}  // namespace dubsar
