// Curvatures of triangle meshes against surfaces whose curvatures are known.

#include "core/relief/curvature/mesh_curvature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

/// A sheet over (u, v) in 0..1, `at` and `normal` of its places.
template <class At, class Normal>
TriMesh sheet(int cells, const At& at, const Normal& normal) {
  TriMesh mesh;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double u = static_cast<double>(i) / cells, v = static_cast<double>(j) / cells;
      mesh.positions.emplace_back(at(u, v));
      mesh.normals.emplace_back(glm::normalize(normal(u, v)));
    }
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j)
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i;
      mesh.triangles.push_back({a, a + 1, a + row + 1});
      mesh.triangles.push_back({a, a + row + 1, a + row});
    }
  return mesh;
}

MeshCurvatures curvatures(const TriMesh& mesh) {
  SilentProgress progress;
  return mesh_curvatures(mesh, progress).value();
}

TEST(MeshCurvature, OfACylinderATorusAndASaddle) {
  constexpr int kCells = 60;
  const std::size_t middle = (kCells + 1) * (kCells / 2) + kCells / 2;
  const auto tube = [](double u, double) { return glm::dvec3(std::sin(u - 0.5), 0.0, std::cos(u - 0.5)); };
  const TriMesh cylinder = sheet(
      kCells, [&](double u, double v) { return 2.0 * tube(u, v) + glm::dvec3(0, 3 * v, 0); }, tube);
  EXPECT_NEAR(curvatures(cylinder).k_max[middle], 0.5, 0.005);
  EXPECT_NEAR(curvatures(cylinder).k_min[middle], 0.0, 0.005);
  // z = (x^2 - 2 y^2) / 2: at the origin curvatures of -1 and 2, where the normal is up and convex counts as positive.
  const auto x = [](double u) { return u - 0.5; };
  const TriMesh saddle = sheet(
      kCells, [&](double u, double v) { return glm::dvec3(x(u), x(v), 0.5 * x(u) * x(u) - x(v) * x(v)); },
      [&](double u, double v) { return glm::dvec3(-x(u), 2 * x(v), 1.0); });
  EXPECT_NEAR(curvatures(saddle).k_max[middle], 2.0, 0.02);
  EXPECT_NEAR(curvatures(saddle).k_min[middle], -1.0, 0.02);
}

TEST(MeshCurvature, WithoutNormalsAndInAnyFrame) {
  TriMesh bowl = sheet(
      80, [](double u, double v) { return glm::dvec3(u, v, 0.25 * ((u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5))); },
      [](double u, double v) { return glm::dvec3(-0.5 * (u - 0.5), -0.5 * (v - 0.5), 1.0); });
  const std::size_t middle = 81 * 40 + 40;
  EXPECT_NEAR(curvatures(bowl).k_min[middle], -0.5, 0.005) << "a hollow, seen from the air";
  bowl.normals.clear();
  EXPECT_NEAR(curvatures(bowl).k_min[middle], -0.5, 0.01);
  EXPECT_NEAR(curvatures(bowl).k_max[middle], -0.5, 0.01);
  bowl.frame.scale = glm::dvec3(0.5);  // half as large: twice as curved
  EXPECT_NEAR(curvatures(bowl).k_min[middle], -1.0, 0.02);
}

TEST(MeshCurvature, ThoseOfTheScanCountWhereThereAreSome) {
  TriMesh mesh = sheet(
      4, [](double u, double v) { return glm::dvec3(u, v, 0.0); }, [](double, double) { return glm::dvec3(0, 0, 1); });
  mesh.k_min.assign(mesh.positions.size(), -0.125f);
  mesh.k_max.assign(mesh.positions.size(), 0.25f);
  mesh.frame.scale = glm::dvec3(0.0625);
  EXPECT_FLOAT_EQ(curvatures(mesh).k_min[3], -2.0f);
  EXPECT_FLOAT_EQ(curvatures(mesh).k_max[3], 4.0f);
  mesh.frame.scale.z = 0.07;  // steps of different lengths: curvature for a step says nothing
  EXPECT_NEAR(curvatures(mesh).k_max[12], 0.0f, 1e-6);
}

}  // namespace
}  // namespace dubsar
