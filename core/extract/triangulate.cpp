#include "core/extract/triangulate.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "core/base/result.h"
#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/extract/cell_pieces.h"

namespace dubsar {
namespace {

constexpr std::int64_t kQuadsPerChunk = 1 << 14;

/// Number of doubled corners and whether two of them are neighbours.
bool needs_steiner(const Polygon& polygon) {
  unsigned doubled = 0;
  for (int i = 0; i + 1 < polygon.size; ++i) {
    if (polygon.corner[static_cast<std::size_t>(i)] == polygon.corner[static_cast<std::size_t>(i) + 1]) {
      doubled |= 1u << polygon.corner[static_cast<std::size_t>(i)];
    }
  }
  return (doubled & (doubled >> 1 | doubled << 3)) != 0;
}

/// True: diagonal between corners 0 and 2.
bool takes_first_diagonal(const std::array<std::uint32_t, 4>& quad, std::span<const glm::vec3> positions,
                          std::span<const glm::vec3> normals) {
  std::array<glm::dvec3, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = glm::dvec3(positions[quad[i]]);
  const glm::dvec3 d02 = p[2] - p[0], d13 = p[3] - p[1];
  const glm::dvec3 mean = glm::cross(d02, d13);  // twice the vector area
  // Twice the areas of the corner triangles, seen along the mean normal: negative at a reflex corner.
  std::array<double, 4> turn;
  for (std::size_t i = 0; i < 4; ++i) {
    turn[i] = glm::dot(glm::cross(p[i] - p[(i + 3) % 4], p[(i + 1) % 4] - p[i]), mean);
  }
  const double worst_first = std::min(turn[1], turn[3]);  // diagonal 0-2 leaves the triangles at corners 1 and 3
  const double worst_second = std::min(turn[0], turn[2]);
  if (worst_first <= 0.0 || worst_second <= 0.0) {
    if (worst_first != worst_second) return worst_first > worst_second;
  } else if (!normals.empty()) {
    // Height of diagonal 0-2 over 1-3, and how far the surface bulges over the diagonals by their curvatures
    // (n2 - n1).(p2 - p1) / |p2 - p1|^2: chord length^2 / 8 times curvature.
    const double height = glm::dot(p[0] + p[2] - p[1] - p[3], mean);
    const double bulge = glm::dot(glm::dvec3(normals[quad[2]] - normals[quad[0]]), d02) +
                         glm::dot(glm::dvec3(normals[quad[3]] - normals[quad[1]]), d13);
    if (height * bulge != 0.0) return (height > 0.0) == (bulge > 0.0);
  } else {
    const auto flatness = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
      const glm::dvec3 n1 = glm::cross(p[b] - p[a], p[c] - p[a]), n2 = glm::cross(p[c] - p[a], p[d] - p[a]);
      return glm::dot(n1, n2) / std::sqrt(glm::dot(n1, n1) * glm::dot(n2, n2));
    };
    const double first = flatness(0, 1, 2, 3), second = flatness(1, 2, 3, 0);
    if (first != second && std::isfinite(first) && std::isfinite(second)) return first > second;
  }
  return std::min(quad[0], quad[2]) < std::min(quad[1], quad[3]);
}

/// Triangles of a polygon with one doubled corner or two opposite ones: only diagonals between opposite corners.
void cut_between_opposite_corners(const Polygon& polygon, Triangle* out) {
  const auto n = static_cast<std::size_t>(polygon.size);
  // Walk both chains between the two ends of the strip: the single corners next to a doubled one.
  std::size_t start = 0;
  const auto is_single = [&](std::size_t i) {
    return polygon.corner[i % n] != polygon.corner[(i + 1) % n] &&
           polygon.corner[i % n] != polygon.corner[(i + n - 1) % n];
  };
  const auto is_doubled = [&](std::size_t i) { return !is_single(i); };
  while (!(is_single(start) && is_doubled(start + 1))) ++start;
  const auto vertex = [&](std::size_t i) { return polygon.vertex[i % n]; };
  // start = corner k - 1; corner k holds start + 1 and start + 2; corner k + 1 is start + 3; corner k + 2 the rest.
  *out++ = {vertex(start), vertex(start + 1), vertex(start + n - 1)};
  *out++ = {vertex(start + 2), vertex(start + 3), vertex(start + 4)};
  *out++ = {vertex(start + 1), vertex(start + 2), vertex(start + n - 1)};
  if (n == 6) *out++ = {vertex(start + 2), vertex(start + 4), vertex(start + 5)};
}

/// Cuts the polygons of a mesh one after the other: first counts, then writes.
class Cutter {
 public:
  struct Count {
    std::int64_t triangles = 0, steiner = 0;
  };

  Cutter(const QuadMesh& mesh, std::span<const glm::vec3> normals, std::uint32_t guided, QuadCuts cuts)
      : mesh_(mesh), normals_(normals), guided_(guided), cuts_(std::move(cuts)) {}
  const std::vector<FacePoint>& face_points() const { return cuts_.face_points; }

  Count count(std::uint32_t q) const {
    const QuadCut cut = cut_of(q);
    if (cut != QuadCut::kFan && !mesh_.has_doubled(q)) return {2, 0};
    const Polygon polygon = mesh_.polygon(q);
    if (cut != QuadCut::kFan && !needs_steiner(polygon)) return {polygon.size - 2, 0};
    Count count{polygon.size, 1};
    if (cut == QuadCut::kFan && !face_points().empty())
      for (int k = 0; k < polygon.size; ++k) count.triangles += point_of_side(polygon, k) != kNoPoint;
    return count;
  }

  /// Puts the triangles of x-quad q behind `out`, and the centre of its fan, if it is one, at `centre`, whose id is
  /// `centre_id`. Face points have ids from `first_face_id` on. Returns as count().
  Count write(std::uint32_t q, Triangle* out, std::uint32_t centre_id, std::uint32_t first_face_id,
              glm::vec3* centre) const {
    const QuadCut cut = cut_of(q);
    if (cut != QuadCut::kFan && !mesh_.has_doubled(q)) {
      const auto& v = mesh_.quads[q];
      const bool first =
          cut == QuadCut::kFirst ||
          (cut != QuadCut::kSecond &&
           takes_first_diagonal(v, mesh_.positions, q < guided_ ? normals_ : std::span<const glm::vec3>{}));
      out[0] = first ? Triangle{v[0], v[1], v[2]} : Triangle{v[1], v[2], v[3]};
      out[1] = first ? Triangle{v[0], v[2], v[3]} : Triangle{v[1], v[3], v[0]};
      return {2, 0};
    }
    const Polygon polygon = mesh_.polygon(q);
    const auto n = static_cast<std::size_t>(polygon.size);
    if (cut != QuadCut::kFan && !needs_steiner(polygon)) {
      cut_between_opposite_corners(polygon, out);
      return {polygon.size - 2, 0};
    }
    Triangle* const begin = out;
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t from = polygon.vertex[k], to = polygon.vertex[(k + 1) % n];
      const std::size_t point = cut == QuadCut::kFan ? point_of_side(polygon, static_cast<int>(k)) : kNoPoint;
      sum += glm::dvec3(mesh_.positions[from]);
      if (point == kNoPoint) {
        *out++ = {from, to, centre_id};
        continue;
      }
      const auto middle = static_cast<std::uint32_t>(first_face_id + point);
      *out++ = {from, middle, centre_id};
      *out++ = {middle, to, centre_id};
    }
    *centre =
        cut == QuadCut::kFan ? point_at(place_polygon(mesh_, q).centre()) : glm::vec3(sum / static_cast<double>(n));
    return {out - begin, 1};
  }

  static glm::vec3 point_at(const ExactPlace& place) {
    return glm::vec3(glm::dvec3(place) / static_cast<double>(kExactSteps));
  }

 private:
  static constexpr std::size_t kNoPoint = std::numeric_limits<std::size_t>::max();

  QuadCut cut_of(std::uint32_t q) const { return mesh_.embedded ? cuts_.of_quad[q] : QuadCut::kFree; }
  std::size_t point_of_side(const Polygon& polygon, int k) const {
    const std::uint32_t a = polygon.vertex[static_cast<std::size_t>(k)],
                        b = polygon.vertex[static_cast<std::size_t>((k + 1) % polygon.size)];
    return find_face_point(face_points(), a, b).value_or(kNoPoint);
  }

  const QuadMesh& mesh_;
  std::span<const glm::vec3> normals_;
  std::uint32_t guided_;
  QuadCuts cuts_;
};

}  // namespace

Triangulation triangulate(const QuadMesh& mesh, std::span<const glm::vec3> vertex_normals, std::size_t more,
                          std::uint32_t guided, std::optional<QuadCuts> cuts) {
  DUBSAR_CHECK(vertex_normals.empty() || vertex_normals.size() == mesh.positions.size());
  Triangulation result;
  if (!cuts) cuts = mesh.embedded ? find_cuts(mesh) : QuadCuts{};
  const Cutter cutter(mesh, vertex_normals, guided, std::move(*cuts));
  const std::int64_t quads = mesh.quad_count();
  const std::int64_t chunks = (quads + kQuadsPerChunk - 1) / kQuadsPerChunk;
  std::vector<std::int64_t> triangle_start(static_cast<std::size_t>(chunks)),
      steiner_start(static_cast<std::size_t>(chunks));
  parallel_chunks(quads, kQuadsPerChunk, [&](std::int64_t begin, std::int64_t end) {
    Cutter::Count sum;
    for (std::int64_t q = begin; q < end; ++q) {
      const Cutter::Count here = cutter.count(static_cast<std::uint32_t>(q));
      sum.triangles += here.triangles;
      sum.steiner += here.steiner;
    }
    triangle_start[static_cast<std::size_t>(begin / kQuadsPerChunk)] = sum.triangles;
    steiner_start[static_cast<std::size_t>(begin / kQuadsPerChunk)] = sum.steiner;
  });
  const std::int64_t triangles = exclusive_scan(triangle_start), centres = exclusive_scan(steiner_start),
                     steiner = centres + static_cast<std::int64_t>(cutter.face_points().size());
  DUBSAR_CHECK(triangles < std::int64_t{1} << 32 && mesh.vertex_count() + steiner < std::int64_t{1} << 32);
  result.triangles.reserve(static_cast<std::size_t>(triangles) + more);
  resize_large(result.triangles, static_cast<std::size_t>(triangles));
  result.steiner.resize(static_cast<std::size_t>(steiner));
  resize_large(result.first_triangle, static_cast<std::size_t>(quads) + 1);
  result.first_triangle.back() = static_cast<std::uint32_t>(triangles);

  const auto first_face_id = static_cast<std::uint32_t>(mesh.vertex_count() + centres);
  parallel_chunks(quads, kQuadsPerChunk, [&](std::int64_t begin, std::int64_t end) {
    auto triangle = static_cast<std::size_t>(triangle_start[static_cast<std::size_t>(begin / kQuadsPerChunk)]);
    auto centre = static_cast<std::size_t>(steiner_start[static_cast<std::size_t>(begin / kQuadsPerChunk)]);
    for (std::int64_t i = begin; i < end; ++i) {
      const auto q = static_cast<std::uint32_t>(i);
      result.first_triangle[q] = static_cast<std::uint32_t>(triangle);
      const Cutter::Count written = cutter.write(q, result.triangles.data() + triangle,
                                                 static_cast<std::uint32_t>(mesh.positions.size() + centre),
                                                 first_face_id, result.steiner.data() + centre);
      triangle += static_cast<std::size_t>(written.triangles);
      centre += static_cast<std::size_t>(written.steiner);
    }
  });
  result.face_points = cutter.face_points();
  for (std::size_t k = 0; k < result.face_points.size(); ++k)
    result.steiner[static_cast<std::size_t>(centres) + k] = Cutter::point_at(result.face_points[k].place);
  return result;
}

}  // namespace dubsar
