#include "core/mesh/tablet_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/mesh/side_relief.h"

namespace dubsar {
namespace {

constexpr std::int64_t kFrameGrain = 1 << 16;
constexpr double kLevel_mm = 0.1;   // what makes no side flat or curved
constexpr double kSparse = 0.5;     // of the writing elsewhere: less is room left
constexpr double kEdges = 0.6;      // what little is written there beside what is seen of whole sides
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

/// Which way the edges of the broad side look: of a square tablet its areas do not say it. They repeat by quarters of a
/// turn, so that the fourth harmonic of the directions, by area, does. Turns the second and third axis in their plane.
glm::dmat3 along_the_edges(const glm::dmat3& axes, std::span<const glm::dvec3> points,
                           std::span<const Triangle> triangles) {
  struct Directions {
    std::complex<double> sum = 0.0;
    double all = 0.0;
  };
  const auto [sum, all] = parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), kFrameGrain, Directions{},
      [&](std::int64_t begin, std::int64_t end) {
        Directions part;
        for (const Triangle& t :
             triangles.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin))) {
          const glm::dvec3 n = glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
          const double area = glm::length(n);
          if (!(area > 0.0)) continue;
          const std::complex<double> direction(glm::dot(n, axes[1]) / area, glm::dot(n, axes[2]) / area);
          if (std::norm(direction) < kUpright) continue;  // of the broad sides, or the wall of an impression
          const std::complex<double> square = direction * direction;
          part.sum += area * square * square;
          part.all += area;
        }
        return part;
      },
      [](const Directions& one, const Directions& other) {
        return Directions{one.sum + other.sum, one.all + other.all};
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

/// What the relief of the six sides says about a direction of reading: skew along any axis of the box, on the side that
/// looks along another.
class Writing {
 public:
  Writing(std::span<const glm::dvec3> points, std::span<const Triangle> triangles,
          const std::array<glm::dvec3, 3>& axes, double step_mm)
      : axes_(axes) {
    parallel_for(6, 1, [&](std::int64_t side) {
      const auto axis = static_cast<std::size_t>(side / 2), sign = static_cast<std::size_t>(side % 2);
      const double s = sign ? -1.0 : 1.0;
      const glm::dvec3 front = s * axes[axis], right = axes[(axis + 1) % 3];
      const auto skew = slope_skew(height_map(points, triangles, {right, glm::cross(front, right), front}, step_mm));
      const glm::dvec3 up = glm::cross(front, right);
      const double along = glm::dot(up, axes[(axis + 2) % 3]) > 0 ? 1.0 : -1.0;
      skew_[axis][sign] = {skew[0], along * skew[1]};
    });
  }

  /// How well impressions on the side `front` fit lines that run to `right` with their tops towards `up`.
  double fit(const glm::dvec3& front, const glm::dvec3& right, const glm::dvec3& up) const {
    return skew(front, up) - skew(front, right);
  }

 private:
  double skew(const glm::dvec3& front, const glm::dvec3& direction) const {
    const auto [axis, sign] = nearest(front);
    const auto [along, turn] = nearest(direction);
    const double value = skew_[axis][sign][along == (axis + 1) % 3 ? 0 : 1];
    return turn ? -value : value;
  }
  std::pair<int, int> nearest(const glm::dvec3& v) const {
    int best = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(glm::dot(v, axes_[k])) > std::abs(glm::dot(v, axes_[best]))) best = k;
    return {best, glm::dot(v, axes_[best]) < 0 ? 1 : 0};
  }

  std::array<glm::dvec3, 3> axes_;
  std::array<std::array<std::array<double, 2>, 2>, 3> skew_{};
};

/// Obverse, lower edge, reverse and upper edge are written while the tablet is turned about `right`.
double turned_while_written(const Writing& writing, const TabletFrame& f) {
  return writing.fit(f.front, f.right, f.up) + writing.fit(-f.front, f.right, -f.up) +
         writing.fit(-f.up, f.right, f.front) + writing.fit(f.up, f.right, -f.front);
}

/// Lines run on over the right edge; the left edge is read downwards.
double edges_beside(const Writing& writing, const TabletFrame& f) {
  return writing.fit(f.right, -f.front, f.up) + writing.fit(-f.right, -f.up, f.front);
}

/// What else tells the obverse, -1 (it is the other side) to 1: it is the flatter one of the broad sides, because wet
/// clay is laid on it when the reverse is written (J. Taylor: Tablets as artefacts, scribes as artisans, 2011), and the
/// text begins on it, so that the side with room left at its end is the reverse.
double obverse_by_shape(std::span<const glm::dvec3> points, std::span<const Triangle> triangles, const TabletFrame& f,
                        double step_mm) {
  struct Side {
    double rise_mm, room_left;
  };
  std::array<Side, 2> sides{};  // front, back
  parallel_for(2, 1, [&](std::int64_t side) {
    const double s = side == 0 ? 1.0 : -1.0;
    const HeightMap map = height_map(points, triangles, {f.right, s * f.up, s * f.front}, step_mm);
    sides[static_cast<std::size_t>(side)] = {side_rise_mm(map), std::max(0.0, 1.0 - written_below(map) / kSparse)};
  });
  const auto& [front, back] = sides;
  const double flatter =
      (back.rise_mm - front.rise_mm) / (std::abs(back.rise_mm) + std::abs(front.rise_mm) + kLevel_mm);
  return flatter + back.room_left - front.room_left;
}

/// Without those that fill holes: nobody wrote there, and their rims are steps.
std::vector<Triangle> seen_triangles(const TriMesh& mesh) {
  if (mesh.triangle_inferred.empty()) return mesh.triangles;
  std::vector<Triangle> seen;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (!mesh.triangle_inferred[t]) seen.push_back(mesh.triangles[t]);
  return seen;
}

/// Areas by direction, and the lengths of one side of each triangle.
struct Extent {
  glm::dmat3 areas{0.0};
  double edges = 0.0;
};
Extent add_up(std::span<const glm::dvec3> points, std::span<const Triangle> triangles) {
  return parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), kFrameGrain, Extent{},
      [&](std::int64_t begin, std::int64_t end) {
        Extent part;
        for (const Triangle& t :
             triangles.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin))) {
          const glm::dvec3 n = glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
          const double area = glm::length(n);
          if (!(area > 0.0)) continue;
          part.areas += glm::outerProduct(n, n / area);
          part.edges += glm::distance(points[t[0]], points[t[1]]);
        }
        return part;
      },
      [](const Extent& one, const Extent& other) {
        return Extent{one.areas + other.areas, one.edges + other.edges};
      });
}

double share(double best, double next) {
  const double all = std::abs(best) + std::abs(next);
  return all > 0.0 ? std::clamp((best - next) / all, 0.0, 1.0) : 0.0;
}

}  // namespace

glm::dmat3 TabletFrame::tablet_from_model() const { return glm::transpose(glm::dmat3(right, up, front)); }

Result<TabletFrame> find_tablet_frame(const TriMesh& mesh) {
  std::vector<glm::dvec3> points(mesh.positions.size());
  parallel_for(static_cast<std::int64_t>(points.size()), kFrameGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    points[v] = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v]));
  });
  const std::vector<Triangle> seen = seen_triangles(mesh);
  const auto [areas, edges] = add_up(points, seen.empty() ? mesh.triangles : seen);
  if (!(areas[0][0] + areas[1][1] + areas[2][2] > 0.0))
    return fail(ErrorKind::kBadData, "the surface has no area, expected a tablet that can be turned upright");
  const glm::dmat3 found = along_the_edges(eigenvectors(areas), points, seen.empty() ? mesh.triangles : seen);
  const std::array<glm::dvec3, 3> axes{along_its_axis(found[0]), along_its_axis(found[1]), along_its_axis(found[2])};
  const double step_mm = edges / static_cast<double>(seen.empty() ? mesh.triangles.size() : seen.size());
  const Writing writing(points, seen, axes, step_mm);

  TabletFrame best, other;
  double best_fit = 0.0, next_fit = 0.0;
  int tried = 0;
  for (const glm::dvec3& right : {axes[1], -axes[1], axes[2], -axes[2]}) {
    const TabletFrame frame{right, glm::cross(axes[0], right), axes[0]};
    const double fit = turned_while_written(writing, frame);
    if (tried == 0 || fit > best_fit) {
      next_fit = tried == 0 ? fit : std::max(next_fit, best_fit);
      best_fit = fit;
      best = frame;
    } else {
      next_fit = tried == 1 ? fit : std::max(next_fit, fit);
    }
    ++tried;
  }
  best.up_share = share(best_fit, next_fit);
  other = turned(best, FrameTurn::kOver);
  if (!(best_fit > 0.0)) return best;
  const double by_edges = (edges_beside(writing, best) - edges_beside(writing, other)) / best_fit;
  const double evidence = kEdges * std::clamp(by_edges, -1.0, 1.0) + obverse_by_shape(points, seen, best, step_mm);
  best.obverse_share = std::clamp(std::abs(evidence), 0.0, 1.0);
  if (evidence >= 0.0) return best;
  other.up_share = best.up_share;
  other.obverse_share = best.obverse_share;
  return other;
}

TabletFrame turned(const TabletFrame& f, FrameTurn turn) {
  TabletFrame out = f;
  switch (turn) {
    case FrameTurn::kNone:
      break;
    case FrameTurn::kHalf:
      out.right = -f.right, out.up = -f.up;
      break;
    case FrameTurn::kLeft:  // the picture turns to the left: what was up points left
      out.right = -f.up, out.up = f.right;
      break;
    case FrameTurn::kRight:
      out.right = f.up, out.up = -f.right;
      break;
    case FrameTurn::kOver:
      out.up = -f.up, out.front = -f.front;
      break;
  }
  return out;
}

TriMesh in_tablet_frame(const TriMesh& mesh, const TabletFrame& frame) {
  TriMesh out = mesh;
  const glm::dmat3 turn = frame.tablet_from_model();
  const glm::dvec3 step = mesh.frame.grid_voxel_mm();
  for (glm::vec3& p : out.positions) p = glm::vec3(turn * mesh.frame.mm_from_grid(glm::dvec3(p)));
  for (glm::vec3& n : out.normals)  // of an uneven grid: normals go with the inverse steps
    n = glm::vec3(glm::normalize(turn * (glm::dvec3(n) / step)));
  out.frame = GridFrame{};
  out.frame.input_voxel.mm = glm::dvec3(1.0);
  out.frame.input_voxel.provenance = mesh.frame.input_voxel.provenance;
  return out;
}

}  // namespace dubsar
