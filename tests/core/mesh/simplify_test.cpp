#include "core/mesh/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/core/extract/extract_help.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

TriMesh to_tri_mesh(const QuadMesh& quads) {
  const Triangulation cut = triangulate(quads, {});
  TriMesh mesh;
  mesh.positions = all_positions(quads, cut);
  mesh.triangles = cut.triangles;
  return mesh;
}

TriMesh sphere_mesh(std::int64_t n) {
  SphereSource source(n);
  return to_tri_mesh(build(sample(source, source.isovalue(), true, 16)));
}

TriMesh run(const TriMesh& mesh, const SimplifyOptions& options) {
  SilentProgress progress;
  auto result = simplify(mesh, options, progress);
  EXPECT_TRUE(result.has_value()) << result.error().message;
  return std::move(*result);
}

double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
  bool inside = true;
  double edge = std::numeric_limits<double>::infinity();
  for (const auto& [s, t] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    inside = inside && glm::dot(glm::cross(t - s, p - s), n) >= 0.0;
    const double at = std::clamp(glm::dot(p - s, t - s) / glm::dot(t - s, t - s), 0.0, 1.0);
    edge = std::min(edge, glm::length(p - s - at * (t - s)));
  }
  return inside ? std::abs(glm::dot(p - a, n)) : edge;
}

/// Largest distance of the vertices and triangle centres of one mesh from the other.
double one_way(const TriMesh& from, const TriMesh& to) {
  std::vector<glm::dvec3> samples(from.positions.begin(), from.positions.end());
  for (const Triangle& t : from.triangles) {
    samples.push_back((samples[t[0]] + samples[t[1]] + samples[t[2]]) / 3.0);
  }
  double worst = 0.0;
  for (const glm::dvec3& p : samples) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& t : to.triangles) {
      nearest = std::min(nearest, distance_to_triangle(p, glm::dvec3(to.positions[t[0]]),
                                                       glm::dvec3(to.positions[t[1]]), glm::dvec3(to.positions[t[2]])));
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(Simplify, SphereStaysClosedAndWithinTheDistance) {
  const TriMesh mesh = sphere_mesh(20);
  for (const double distance : {0.1, 0.3}) {
    const TriMesh small = run(mesh, {.max_angle_rad = 0.6, .max_distance_vox = distance});
    const MeshCheck found = check_mesh(small.positions, small.triangles);
    EXPECT_TRUE(found.watertight());
    EXPECT_EQ(found.euler, 2);
    EXPECT_EQ(found.zero_area_triangles, 0);
    EXPECT_LE(one_way(mesh, small), distance);
    EXPECT_LE(one_way(small, mesh), distance);
    // The best possible is an order of magnitude below: the bound on the distance adds up and is never exact.
    EXPECT_LT(static_cast<double>(small.triangles.size()),
              (distance > 0.2 ? 0.25 : 0.6) * static_cast<double>(mesh.triangles.size()));
  }
}

TEST(Simplify, FlatBoxCollapsesToFewTriangles) {
  Volume<float> volume({24, 20, 16});
  std::fill_n(volume.voxels.data(), volume.dims.count(), 1.0f);
  const TriMesh mesh = to_tri_mesh(build(sample(volume, 0.5f)));
  const TriMesh small = run(mesh, {.max_angle_rad = 0.1, .max_distance_vox = 0.01});
  const MeshCheck found = check_mesh(small.positions, small.triangles);
  EXPECT_TRUE(found.watertight());
  EXPECT_EQ(found.euler, 2);
  EXPECT_GT(mesh.triangles.size(), 4000u);
  EXPECT_LT(small.triangles.size(), 200u);
  double volume_enclosed = 0.0;
  for (const Triangle& t : small.triangles) {
    volume_enclosed += glm::dot(glm::dvec3(small.positions[t[0]]),
                                glm::cross(glm::dvec3(small.positions[t[1]]), glm::dvec3(small.positions[t[2]]))) /
                       6.0;
  }
  EXPECT_NEAR(volume_enclosed, 23.0 * 19.0 * 15.0, 1e-6) << "edges or corners were cut";
}

TEST(Simplify, TheNormalConeStopsItWhereTheDistanceDoesNot) {
  const TriMesh mesh = sphere_mesh(28);
  const TriMesh wide = run(mesh, {.max_angle_rad = 0.8, .max_distance_vox = 5.0});
  const TriMesh narrow = run(mesh, {.max_angle_rad = 0.2, .max_distance_vox = 5.0});
  EXPECT_LT(2 * wide.triangles.size(), narrow.triangles.size());
  for (const Triangle& t : narrow.triangles) {
    const glm::dvec3 a(narrow.positions[t[0]]), b(narrow.positions[t[1]]), c(narrow.positions[t[2]]);
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const glm::dvec3 radial = glm::normalize((a + b + c) / 3.0 - glm::dvec3(13.5));
    EXPECT_LT(std::acos(glm::dot(normal, radial)), 0.2 + 0.15) << "0.15: the original triangles against the sphere";
  }
}

TEST(Simplify, ManifoldsStayManifoldsWithTheirTopology) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const bool closed = seed % 2 == 0;
    const TriMesh mesh =
        to_tri_mesh(build(sample(random_volume({14, 13, 12}, seed, static_cast<int>(seed % 5)), 0.0f, closed)));
    const TriMesh small = run(mesh, {.max_angle_rad = 1.5, .max_distance_vox = 0.5});
    const MeshCheck before = check_mesh(mesh.positions, mesh.triangles);
    const MeshCheck after = check_mesh(small.positions, small.triangles);
    EXPECT_LT(after.triangles, before.triangles);
    EXPECT_TRUE(after.manifold());
    EXPECT_EQ(after.euler, before.euler);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.boundary_edges, before.boundary_edges);
  }
}

TEST(Simplify, AttributesAndPartBordersAreKept) {
  TriMesh mesh = sphere_mesh(24);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.k_min.push_back(mesh.positions[v].y);
    mesh.normals.push_back(mesh.positions[v]);
  }
  const auto side = [&](const TriMesh& of, const Triangle& t) {
    return of.positions[t[0]].x + of.positions[t[1]].x + of.positions[t[2]].x > 3 * 11.5f;
  };
  std::vector<std::array<bool, 2>> seen(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    mesh.triangle_partition.push_back(side(mesh, t));
    for (const std::uint32_t v : t) seen[v][side(mesh, t)] = true;
  }
  std::vector<glm::vec3> border;
  for (std::size_t v = 0; v < seen.size(); ++v)
    if (seen[v][0] && seen[v][1]) border.push_back(mesh.positions[v]);
  ASSERT_GT(border.size(), 20u);
  const TriMesh small = run(mesh, {.max_angle_rad = 0.5, .max_distance_vox = 0.2});
  ASSERT_LT(small.positions.size(), mesh.positions.size() / 2);
  ASSERT_EQ(small.triangle_partition.size(), small.triangles.size());
  EXPECT_TRUE(small.ao.empty());
  for (std::size_t v = 0; v < small.positions.size(); ++v) {
    EXPECT_EQ(small.k_min[v], small.positions[v].y);
    EXPECT_EQ(small.normals[v], small.positions[v]);
  }
  for (const glm::vec3& p : border) EXPECT_NE(std::ranges::find(small.positions, p), small.positions.end());
  for (std::size_t t = 0; t < small.triangles.size(); ++t)
    EXPECT_EQ(small.partition_of(t), side(small, small.triangles[t]));
}

TEST(Simplify, SameMeshTwiceGivesTheSameTriangles) {
  const TriMesh mesh = sphere_mesh(24);
  const TriMesh a = run(mesh, {}), b = run(mesh, {});
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.positions, b.positions);
}

TEST(Simplify, BadInputIsRefusedAndCancelStops) {
  SilentProgress progress;
  TriMesh mesh = sphere_mesh(8);
  for (const SimplifyOptions& bad : {SimplifyOptions{-0.1, 0.1}, SimplifyOptions{2.0, 0.1}, SimplifyOptions{0.1, 0.0},
                                     SimplifyOptions{0.1, NAN}, SimplifyOptions{NAN, 0.1}}) {
    EXPECT_EQ(simplify(mesh, bad, progress).error().kind, ErrorKind::kUsage);
  }
  progress.cancel();
  EXPECT_EQ(simplify(mesh, {}, progress).error().kind, ErrorKind::kCancelled);
  mesh.triangles[0][1] = 1000000;
  EXPECT_EQ(simplify(mesh, {}, progress).error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
