#include "core/relief/smoothing/smooth.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/extract/cell_box.h"
#include "core/relief/smoothing/quad_sums.h"
#include "core/relief/smoothing/scatter_blocks.h"

namespace dubsar {
namespace {

constexpr std::int64_t kSmoothGrain = 16384;

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Calls visit(position) for each vertex of the polygon of `face`, in order; returns their number.
template <class Visit>
int for_polygon(const QuadMesh& mesh, std::span<const glm::vec3> positions, std::size_t face, const Visit& visit) {
  const auto q = static_cast<std::uint32_t>(face);
  if (!mesh.has_doubled(q)) {
    for (const std::uint32_t v : mesh.quads[face]) visit(positions[v]);
    return 4;
  }
  const Polygon polygon = mesh.polygon(q);
  for (int i = 0; i < polygon.size; ++i) visit(positions[polygon.vertex[index(i)]]);
  return polygon.size;
}

glm::vec3 area_vector(const QuadMesh& mesh, std::span<const glm::vec3> positions, std::size_t face) {
  // Relative to the first vertex, so that large coordinates do not cancel.
  const auto& quad = mesh.quads[face];
  const glm::vec3 origin = positions[quad[0]];
  if (!mesh.has_doubled(static_cast<std::uint32_t>(face))) {  // as below, without what is 0
    const glm::vec3 a = positions[quad[1]] - origin, b = positions[quad[2]] - origin, c = positions[quad[3]] - origin;
    return 0.5f * (glm::vec3(0.0f) + glm::cross(a, b) + glm::cross(b, c));
  }
  glm::vec3 sum{0.0f}, previous{0.0f};
  for_polygon(mesh, positions, face, [&](const glm::vec3& p) {
    const glm::vec3 here = p - origin;
    sum += glm::cross(previous, here);
    previous = here;
  });
  return 0.5f * sum;
}

struct AngleSum {
  double angle = 0.0;
  std::int64_t faces = 0;
};

/// Mean angle in degrees between `faces` and the polygons as they lie.
double mean_angle_deg(const QuadMesh& mesh, std::span<const glm::vec3> positions, std::span<const glm::vec4> faces) {
  const AngleSum sum = parallel_reduce(
      mesh.quad_count(), kSmoothGrain, AngleSum{},
      [&](std::int64_t begin, std::int64_t end) {
        AngleSum part;
        for (std::int64_t f = begin; f < end; ++f) {
          const glm::vec3 a = area_vector(mesh, positions, index(f)), n(faces[index(f)]);
          const float sine = glm::length(glm::cross(a, n)), cosine = glm::dot(a, n);
          if (sine == 0.0f && cosine == 0.0f) continue;
          part.angle += static_cast<double>(std::atan2(sine, cosine));
          ++part.faces;
        }
        return part;
      },
      [](AngleSum a, AngleSum b) {
        return AngleSum{a.angle + b.angle, a.faces + b.faces};
      });
  return sum.faces ? sum.angle / static_cast<double>(sum.faces) * 57.29577951308232 : 0.0;
}

/// One Jacobi step from `from` to `to`. planes: xyz filtered normal, w distance of the plane through the centroid.
void move_vertices(const QuadMesh& mesh, std::span<const glm::vec3> start, const std::vector<glm::vec3>& from,
                   std::vector<glm::vec3>& to, std::vector<glm::vec4>& planes, float max_displacement,
                   Progress& progress) {
  parallel_chunks(mesh.quad_count(), kSmoothGrain, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    for (std::int64_t f = begin; f < end; ++f) {
      glm::vec3 sum{0.0f};
      const int corners = for_polygon(mesh, from, index(f), [&](const glm::vec3& p) { sum += p; });
      glm::vec4& plane = planes[index(f)];
      plane.w = glm::dot(glm::vec3(plane), sum) / static_cast<float>(corners);
    }
    progress.advance(end - begin);
  });
  parallel_chunks(mesh.vertex_count(), kSmoothGrain, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    for (std::int64_t v = begin; v < end; ++v) {
      const glm::vec3 p = from[index(v)];
      glm::vec3 sum{0.0f};
      const auto quads = mesh.quads_of(static_cast<std::uint32_t>(v));
      for (const std::uint32_t q : quads) {
        const glm::vec4 plane = planes[q];
        const glm::vec3 n(plane);
        sum += n * (plane.w - glm::dot(n, p));
      }
      if (!quads.empty()) sum /= static_cast<float>(quads.size());
      glm::vec3 moved = p + sum - start[index(v)];
      const float length = glm::length(moved);
      if (length > max_displacement) moved *= max_displacement / length;
      to[index(v)] = start[index(v)] + moved;
      if (mesh.embedded) to[index(v)] = kept_in_cell(start[index(v)], to[index(v)]);
    }
  });
}

struct Displacement {
  double sum = 0.0, largest = 0.0;
  std::int64_t clamped = 0;
};

Displacement displacement(std::span<const glm::vec3> a, std::span<const glm::vec3> b, double limit) {
  return parallel_reduce(
      static_cast<std::int64_t>(a.size()), kSmoothGrain, Displacement{},
      [&](std::int64_t begin, std::int64_t end) {
        Displacement part;
        for (std::int64_t v = begin; v < end; ++v) {
          const auto length = static_cast<double>(glm::length(a[index(v)] - b[index(v)]));
          part.sum += length;
          part.largest = std::max(part.largest, length);
          part.clamped += length > limit * 0.999;
        }
        return part;
      },
      [](Displacement x, Displacement y) {
        return Displacement{x.sum + y.sum, std::max(x.largest, y.largest), x.clamped + y.clamped};
      });
}

}  // namespace

std::vector<glm::vec4> face_normals(const QuadMesh& mesh) {
  auto faces = large_array<std::vector<glm::vec4>>(mesh.quads.size());
  fill_face_normals(mesh, faces);
  return faces;
}

void fill_face_normals(const QuadMesh& mesh, std::span<glm::vec4> faces) {
  DUBSAR_CHECK(faces.size() == mesh.quads.size());
  parallel_chunks(mesh.quad_count(), kSmoothGrain,
                  [&](std::int64_t begin, std::int64_t end) { quad_normals(mesh, begin, end, faces.data()); });
}

std::vector<glm::vec3> vertex_normals(const QuadMesh& mesh, std::span<const glm::vec4> faces) {
  DUBSAR_CHECK(faces.size() == mesh.quads.size());
  auto normals = large_array<std::vector<glm::vec3>>(mesh.positions.size());
  if (faces.empty()) {
    std::fill(normals.begin(), normals.end(), glm::vec3(0.0f, 0.0f, 1.0f));
    return normals;
  }
  scatter_to_vertices(mesh, kNormalFloats, [&](float* rows, std::int64_t first, std::int64_t size, const auto& groups) {
    const VertexSums sums{
        &mesh, &faces.front().x, nullptr, rows, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(size)};
    for (const std::uint32_t group : groups) add_corner_normals(sums, group);
    finish_normals(sums, normals.data());
  });
  return normals;
}

Result<SmoothStats> smooth(QuadMesh& mesh, std::vector<glm::vec3>& normals, const SmoothOptions& options,
                           Progress& progress) {
  const std::int64_t iterations = options.normals.iterations + options.vertex_iterations;
  progress.begin("smooth", mesh.quad_count() * iterations, "face iteration");
  std::vector<glm::vec4> faces = face_normals(mesh);
  {
    DUBSAR_ASSIGN(const FaceNeighbours neighbours, FaceNeighbours::build(mesh, progress));
    DUBSAR_TRY(filter_normals(neighbours, options.normals, faces, progress));
  }
  SmoothStats stats;
  std::vector<glm::vec3> from = mesh.positions, to(mesh.positions.size());
  for (int iteration = 0; iteration < options.vertex_iterations; ++iteration) {
    move_vertices(mesh, mesh.positions, from, to, faces, options.max_displacement_vox, progress);
    if (progress.cancelled()) return cancelled_error();
    from.swap(to);
  }
  const auto limit = static_cast<double>(options.max_displacement_vox);
  const Displacement moved = displacement(from, mesh.positions, limit);
  const double count = std::max(1.0, static_cast<double>(mesh.vertex_count()));
  stats.mean_displacement_vox = moved.sum / count;
  stats.max_displacement_vox = moved.largest;
  stats.clamped_fraction = static_cast<double>(moved.clamped) / count;
  stats.residual_angle_deg = mean_angle_deg(mesh, from, faces);

  mesh.positions.swap(from);
  normals = vertex_normals(mesh, faces);
  progress.end();
  return stats;
}

}  // namespace dubsar
