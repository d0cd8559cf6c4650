// Smoothing, curvature and light on meshes of the real extraction, split cells included.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "core/extract/extract.h"
#include "core/extract/triangulate.h"
#include "core/mesh/mesh_check.h"
#include "core/relief/curvature/curvature.h"
#include "core/relief/curvature/shape_class.h"
#include "core/relief/occlusion/occlusion.h"
#include "core/relief/smoothing/smooth.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

QuadMesh extract(const Volume<float>& volume, int bits = 4) {
  VolumeSource source(volume);
  SilentProgress progress;
  auto samples = sample_surface(source, {.isovalue = 0.0f, .offset_bits = bits}, progress);
  EXPECT_TRUE(samples);
  auto mesh = build_quad_mesh(*samples, progress);
  EXPECT_TRUE(mesh);
  return std::move(*mesh);
}

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

TEST(Postprocess, RandomVolumesStayFiniteBoundedAndManifold) {
  for (int kind = 0; kind < 5; ++kind) {
    QuadMesh mesh = extract(random_volume({17, 16, 15}, 77u + static_cast<unsigned>(kind), kind));
    ASSERT_GT(mesh.doubled.size(), 20u);
    const std::vector<glm::vec3> start = mesh.positions;
    std::vector<glm::vec3> normals;
    SilentProgress progress;
    ASSERT_TRUE(smooth(mesh, normals, {}, progress));
    const auto k = principal_curvatures(mesh, normals, CurvatureMethod::kFit, progress);
    ASSERT_TRUE(k);
    for (std::size_t v = 0; v < start.size(); ++v) {
      ASSERT_TRUE(finite(mesh.positions[v])) << kind;
      ASSERT_LE(glm::length(mesh.positions[v] - start[v]), 0.0801f) << kind;
      ASSERT_NEAR(glm::length(normals[v]), 1.0f, 1e-4f) << kind;
      ASSERT_TRUE(std::isfinite(k->k_min[v]) && std::isfinite(k->k_max[v])) << kind;
      ASSERT_LE(k->k_min[v], k->k_max[v]) << kind;
    }
    Triangulation triangles = triangulate(mesh, normals);
    std::vector<glm::vec3> positions = mesh.positions;
    positions.insert(positions.end(), triangles.steiner.begin(), triangles.steiner.end());
    const MeshCheck check = check_mesh(positions, triangles.triangles);
    EXPECT_TRUE(check.watertight()) << kind;
    normals.resize(positions.size(), glm::vec3(0, 0, 1));
    const auto light =
        ambient_light({positions, normals, triangles.triangles}, {.rays = 16, .radius_vox = 8.0f}, progress);
    ASSERT_TRUE(light);
    for (const float value : *light) ASSERT_TRUE(value >= 0.0f && value <= 1.0f) << kind;
  }
}

TEST(Postprocess, SphereOfTheRealExtractionHasItsNormalsCurvatureAndLight) {
  constexpr std::int64_t kSide = 52;
  constexpr double kRadius = 20.0;
  const glm::dvec3 c(25.7, 25.4, 25.6);
  Volume<float> volume({kSide, kSide, kSide});
  for (std::int64_t z = 0; z < kSide; ++z)
    for (std::int64_t y = 0; y < kSide; ++y)
      for (std::int64_t x = 0; x < kSide; ++x)
        volume.at(x, y, z) = static_cast<float>(kRadius - glm::length(glm::dvec3(x, y, z) - c));
  QuadMesh mesh = extract(volume);
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  ASSERT_TRUE(smooth(mesh, normals, {}, progress));
  const auto k = principal_curvatures(mesh, normals, CurvatureMethod::kFit, progress);
  ASSERT_TRUE(k);
  double worst_radius = 0, angle = 0, mean_curvature = 0;
  int caps = 0;
  const auto count = static_cast<double>(normals.size());
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const glm::dvec3 d = glm::dvec3(mesh.positions[v]) - c;
    worst_radius = std::max(worst_radius, std::abs(glm::length(d) - kRadius));
    angle += std::acos(std::min(1.0, glm::dot(glm::normalize(d), glm::dvec3(normals[v])))) * 57.29578 / count;
    mean_curvature += 0.5 * static_cast<double>(k->k_min[v] + k->k_max[v]) / count;
    caps += shape_of(shape_class(k->k_min[v], k->k_max[v])) >= 7;
  }
  EXPECT_LT(worst_radius, 0.1);
  EXPECT_LT(angle, 1.1);
  EXPECT_NEAR(mean_curvature, 1 / kRadius, 0.001);
  EXPECT_GT(caps, 0.97 * count);
  const Triangulation triangles = triangulate(mesh, normals);
  ASSERT_TRUE(triangles.steiner.empty());
  const auto light = ambient_light({mesh.positions, normals, triangles.triangles}, {.rays = 40}, progress);
  ASSERT_TRUE(light);
  double mean = 0;
  for (const float value : *light) mean += static_cast<double>(value) / count;
  EXPECT_GT(mean, 0.9999);
}

}  // namespace
}  // namespace dubsar
