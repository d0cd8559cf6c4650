// Packing of a mesh for the GPU: precision, order, refusals.

#include "display/render/mesh/gpu_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

glm::dvec3 decode(const std::array<std::int16_t, 2>& code) {  // as shaders/mesh.vert
  double x = code[0] / 32767.0, y = code[1] / 32767.0;
  const double z = 1 - std::abs(x) - std::abs(y), t = std::max(-z, 0.0);
  x -= x >= 0 ? t : -t;
  y -= y >= 0 ? t : -t;
  return glm::normalize(glm::dvec3(x, y, z));
}

TEST(PackMesh, OctahedralNormalsAreWithinASixtiethOfADegree) {
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  double worst = 1;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random)));
    worst = std::min(worst, glm::dot(n, decode(encode_octahedral(n))));
  }
  for (const glm::dvec3 n : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 0, 1)})
    EXPECT_NEAR(glm::length(decode(encode_octahedral(n)) - n), 0, 1e-12);
  EXPECT_LT(std::acos(worst) * 180 / std::numbers::pi, 1.0 / 60);
  EXPECT_EQ(encode_octahedral({0, 0, 0}), (std::array<std::int16_t, 2>{0, 0}));
}

TEST(PackMesh, PositionsAreWithinHalfAStepOfTheBoxInMillimetres) {
  TriMesh mesh = testing::sphere(30, 20, 40);
  mesh.frame.scale = {2, 2, 2};
  mesh.frame.origin_vox = {5, 6, 7};
  mesh.frame.input_voxel.mm = {0.1, 0.2, 0.3};
  const PackedMesh packed = pack_mesh(mesh).value();
  EXPECT_NEAR(packed.box_mm.size().z, 2 * 30 * 2 * 0.3, 1e-5);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3 mm = mesh.frame.mm_from_grid(mesh.positions[i]);
    for (int a = 0; a < 3; ++a) {
      const double step = packed.box_mm.size()[a] / 65535;
      EXPECT_LE(std::abs(packed.box_mm.min[a] + packed.vertices[i].position[a] * step - mm[a]), 0.501 * step);
    }
  }
}

TEST(PackMesh, NormalsOfAnisotropicVoxelsAreThoseOfTheSurfaceInMillimetres) {
  TriMesh mesh = testing::sphere(30, 90, 180);
  mesh.frame.input_voxel.mm = {1, 1, 3};  // a prolate ellipsoid: n ~ (x/a^2, y/b^2, z/c^2)
  const PackedMesh given = pack_mesh(mesh).value();
  TriMesh bare = mesh;
  bare.normals.clear();
  const PackedMesh computed = pack_mesh(bare).value();
  for (std::size_t i = 200; i + 200 < mesh.positions.size(); i += 37) {
    const glm::dvec3 mm = mesh.frame.mm_from_grid(mesh.positions[i]);
    const glm::dvec3 n = glm::normalize(mm / glm::dvec3(1, 1, 9));
    EXPECT_GT(glm::dot(decode(given.vertices[i].normal), n), std::cos(0.001));
    EXPECT_GT(glm::dot(decode(computed.vertices[i].normal), n), std::cos(0.03)) << "vertex " << i;
  }
}

TEST(PackMesh, AttributesArePackedInSixteenBits) {
  TriMesh mesh;
  testing::add_rectangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 5);
  mesh.shape = {0, 1, 100, 126};
  mesh.ao = {0, 63, 17, 255};
  const PackedMesh packed = pack_mesh(mesh).value();
  const unsigned expected[] = {0u | 0u << 7, 1u | 63u << 7, 100u | 17u << 7, 126u | 63u << 7};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(packed.vertices[i].attributes, expected[i] | 5u << 13);
  mesh.shape.clear();
  mesh.ao.clear();
  EXPECT_EQ(pack_mesh(mesh).value().vertices[0].attributes, 0u | 63u << 7 | 5u << 13) << "unknown means flat and open";
}

TEST(PackMesh, TrianglesAreSortedByPartitionAndNotFiniteOnesDropped) {
  TriMesh mesh;
  for (const std::uint8_t p : std::to_array<std::uint8_t>({6, 1, 6, 0, 1}))
    testing::add_rectangle(mesh, {p, static_cast<float>(mesh.positions.size()), 0}, {1, 0, 0}, {0, 1, 0}, p);
  mesh.positions[7].x = std::numeric_limits<float>::quiet_NaN();  // vertex 3 of the second rectangle
  const PackedMesh packed = pack_mesh(mesh).value();
  EXPECT_EQ(packed.first_triangle, (std::array<std::int64_t, 9>{0, 2, 5, 5, 5, 5, 5, 9, 9}));
  EXPECT_EQ(packed.triangles[0], (Triangle{12, 13, 14}));
  EXPECT_EQ(packed.triangles[2], (Triangle{4, 5, 6}));
  EXPECT_EQ(packed.triangles[3], (Triangle{16, 17, 18}));
  EXPECT_EQ(packed.triangles_of(0b1000010), 7);
  EXPECT_EQ(packed.box_of(0b0000001).min, glm::dvec3(0, 12, 0));
  EXPECT_EQ(packed.box_of(0b0000001).max, glm::dvec3(1, 13, 0));
  EXPECT_EQ(packed.box_of(0b0000100).size(), glm::dvec3(0, 0, 0));
}

TEST(PackMesh, MeshesThatContradictThemselvesAreRefused) {
  const auto refused = [](const TriMesh& mesh) {
    const auto packed = pack_mesh(mesh);
    return !packed && packed.error().kind == ErrorKind::kBadData;
  };
  TriMesh mesh;
  testing::add_rectangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  EXPECT_FALSE(refused(mesh));
  TriMesh bad = mesh;
  bad.triangles[1][2] = 4;
  EXPECT_TRUE(refused(bad));
  bad = mesh;
  bad.normals.pop_back();
  EXPECT_TRUE(refused(bad));
  bad = mesh;
  bad.shape = {1};
  EXPECT_TRUE(refused(bad));
  bad = mesh;
  bad.triangle_partition[1] = 8;
  EXPECT_TRUE(refused(bad));
  bad.triangle_partition = {0};
  EXPECT_TRUE(refused(bad));
}

}  // namespace
}  // namespace dubsar
