#include "core/mesh_io/vertex_places.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <span>

#include "core/mesh/mesh_check.h"
#include "core/mesh_io/weld.h"

namespace dubsar {
namespace {

constexpr double kFar = 64.0;  // extents from the origin on: float keeps 1/260 000 of the extent there

std::int64_t open_edges(const std::vector<glm::vec3>& places, const std::vector<Triangle>& triangles) {
  const MeshCheck check = check_mesh(places, triangles);
  return check.boundary_edges + check.nonmanifold_edges;
}

}  // namespace

bool is_finite_place(const glm::vec3& place) noexcept {
  return std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
}

void set_places(TriMesh& mesh, const std::vector<glm::dvec3>& places) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::dvec3& p : places) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  glm::dvec3 origin(0.0);
  if (!places.empty()) {
    const glm::dvec3 size = high - low, reach = glm::max(glm::abs(low), glm::abs(high));
    const double extent = std::max({size.x, size.y, size.z});
    if (extent > 0 && std::max({reach.x, reach.y, reach.z}) > kFar * extent) origin = glm::round(0.5 * (low + high));
  }
  mesh.frame.origin_vox += mesh.frame.scale * origin;
  mesh.positions.clear();
  mesh.positions.reserve(places.size());
  for (const glm::dvec3& p : places) mesh.positions.emplace_back(p - origin);
}

void join_equal_places(TriMesh& mesh) {
  PointWelder welder;
  std::vector<std::uint32_t> joined;
  joined.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) joined.push_back(welder.id(p));
  const std::size_t count = welder.points().size();
  if (count == mesh.positions.size()) return;
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& t : triangles)
    for (std::uint32_t& v : t) v = joined[v];
  const std::int64_t before = open_edges(mesh.positions, mesh.triangles);
  if (before == 0 || open_edges(welder.points(), triangles) >= before) return;
  std::size_t kept = 0;  // what has no area left is gone
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& corners = triangles[t];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    if (!mesh.triangle_partition.empty()) mesh.triangle_partition[kept] = mesh.triangle_partition[t];
    mesh.triangles[kept++] = corners;
  }
  mesh.triangles.resize(kept);
  if (!mesh.triangle_partition.empty()) mesh.triangle_partition.resize(kept);
  if (!mesh.normals.empty()) {
    std::vector<glm::dvec3> sums(count, glm::dvec3(0.0));
    for (std::size_t v = 0; v < joined.size(); ++v) sums[joined[v]] += glm::dvec3(mesh.normals[v]);
    mesh.normals.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
      const double length = glm::length(sums[v]);
      mesh.normals[v] = length > 0 ? glm::vec3(sums[v] / length) : glm::vec3(0.0f);
    }
  }
  if (!mesh.colors.empty()) {
    std::vector<glm::dvec4> sums(count, glm::dvec4(0.0));
    for (std::size_t v = 0; v < joined.size(); ++v)
      sums[joined[v]] += glm::dvec4(mesh.colors[v][0], mesh.colors[v][1], mesh.colors[v][2], 1.0);
    mesh.colors.resize(count);
    for (std::size_t v = 0; v < count; ++v)
      for (int c = 0; c < 3; ++c)
        mesh.colors[v][static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(sums[v][c] / sums[v].w));
  }
  mesh.positions = std::move(welder.points());
}

}  // namespace dubsar
