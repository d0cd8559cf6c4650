#include "core/relief/smoothing/smooth.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstring>
#include <glm/vector_relational.hpp>
#include <map>
#include <random>

#include "core/base/system/parallel.h"
#include "tests/core/mesh/shape_meshes.h"
#include "tests/core/relief/same_bytes.h"

namespace dubsar {
namespace {
using namespace test;

double angle_deg(glm::vec3 a, glm::vec3 b) {
  return std::atan2(static_cast<double>(glm::length(glm::cross(a, b))), static_cast<double>(glm::dot(a, b))) * 180 /
         kPi;
}

QuadMesh quantised_sphere(int n, double radius, int bits) {
  const glm::dvec3 c(0.5 * n + 0.1, 0.5 * n - 0.2, 0.5 * n + 0.05);
  return dual_mesh(n, bits, [=](glm::dvec3 p) { return radius - glm::length(p - c); });
}

/// Two quads and a pentagon: corner 1 of the middle quad is doubled.
QuadMesh mesh_with_doubled_corner() {
  QuadMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1.5f, 0.5f, 0}, {2, 0, 0}, {2, 1, 0}};
  mesh.quads = {{0, 1, 2, 3}, {1, 5, 6, 4}};
  mesh.doubled = {{0, 4, 1}};
  mesh.build_incidence();
  return mesh;
}

TEST(FaceNeighbours, CountSharedVerticesLikeABruteForceSearch) {
  QuadMesh mesh = quantised_sphere(24, 9.3, 4);
  mesh.doubled = {{3, mesh.quads[40][0], 2}, {700, 5, 0}};  // not a sensible surface, but a valid incidence
  mesh.build_incidence();
  SilentProgress progress;
  const auto built = FaceNeighbours::build(mesh, progress);
  ASSERT_TRUE(built);
  std::size_t seen = 0;
  for (const auto& chunk : built->chunks())
    for (std::size_t i = 0; i < static_cast<std::size_t>(chunk.faces); ++i, ++seen) {
      const std::uint32_t face = chunk.order[i];
      std::map<std::uint32_t, std::uint32_t> expected, found;
      const Polygon polygon = mesh.polygon(face);
      for (int k = 0; k < polygon.size; ++k)
        for (const std::uint32_t other : mesh.quads_of(polygon.vertex[static_cast<std::size_t>(k)]))
          if (other != face) ++expected[other];
      for (auto& [other, count] : expected) count = std::min(count, 3u);
      const std::size_t slice = i / FaceNeighbours::kLanes, lane = i % FaceNeighbours::kLanes;
      for (std::uint32_t row = chunk.first_row[slice]; row < chunk.first_row[slice + 1]; ++row) {
        const std::uint32_t entry = chunk.entries[std::size_t{row} * FaceNeighbours::kLanes + lane];
        if (entry >> FaceNeighbours::kIndexBits)
          found[entry & FaceNeighbours::kIndexMask] = entry >> FaceNeighbours::kIndexBits;
      }
      ASSERT_EQ(found, expected) << "face " << face;
    }
  EXPECT_EQ(seen, mesh.quads.size());
}

TEST(FaceNeighbours, RegularGridHasFourOfWeightTwoAndFourOfWeightOne) {
  const QuadMesh mesh = torus(40, 30, 20, 6);
  SilentProgress progress;
  const auto built = FaceNeighbours::build(mesh, progress);
  ASSERT_TRUE(built);
  std::int64_t ones = 0, twos = 0;
  for (const auto& chunk : built->chunks())
    for (int i = 0; i < chunk.faces; ++i)
      for (std::uint32_t row = 0; row < 8; ++row) {
        const auto lane = static_cast<std::size_t>(i);
        const std::uint32_t entry = chunk.entries[(chunk.first_row[lane / 16] + row) * std::size_t{16} + lane % 16] >>
                                    FaceNeighbours::kIndexBits;
        ones += entry == 1;
        twos += entry == 2;
      }
  EXPECT_EQ(ones, 4 * 1200);
  EXPECT_EQ(twos, 4 * 1200);
}

TEST(NormalFilter, AgreesWithTheFormulaInDoublePrecision) {
  const QuadMesh mesh = quantised_sphere(30, 11.7, 2);
  const std::vector<glm::vec4> start = face_normals(mesh);
  const NormalFilterOptions options{.iterations = 1, .median_steps = 2, .epsilon = 0.02f};
  SilentProgress progress;
  std::vector<glm::vec4> filtered = start;
  const auto neighbours = FaceNeighbours::build(mesh, progress);
  ASSERT_TRUE(neighbours);
  ASSERT_TRUE(filter_normals(*neighbours, options, filtered, progress));
  double worst = 0;
  for (std::uint32_t f = 0; f < mesh.quads.size(); ++f) {
    std::map<std::uint32_t, double> weight{{f, 2.0}};
    for (const std::uint32_t v : mesh.quads[f])
      for (const std::uint32_t other : mesh.quads_of(v))
        if (other != f) weight[other] += 1.0;
    glm::dvec3 m = glm::normalize(glm::dvec3(glm::vec3(start[f])));
    for (int step = 0; step < 2; ++step) {
      glm::dvec3 sum(0.0);
      for (const auto& [other, w] : weight) {
        const auto n = glm::dvec3(glm::vec3(start[other]));
        sum += w * static_cast<double>(start[other].w) / (glm::length(n - m) + 0.02) * n;
      }
      m = glm::normalize(sum);
    }
    worst = std::max(worst, glm::length(m - glm::dvec3(glm::vec3(filtered[f]))));
    EXPECT_EQ(filtered[f].w, start[f].w);
  }
  EXPECT_LT(worst, 2e-6);
}

TEST(NormalFilter, SameBytesOnEveryInstructionSet) {
  const QuadMesh mesh = quantised_sphere(40, 16.4, 4);
  SilentProgress progress;
  const auto neighbours = FaceNeighbours::build(mesh, progress);
  std::vector<glm::vec4> first;
  int targets = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    std::vector<glm::vec4> faces = face_normals(mesh);
    ASSERT_TRUE(filter_normals(*neighbours, {}, faces, progress));
    if (first.empty()) first = faces;
    EXPECT_TRUE(test::same_bytes(faces, first)) << hwy::TargetName(target);
    ++targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(targets, 1);
}

TEST(NormalFilter, KeepsAPlaneAndAnEdgeOfNinetyDegrees) {
  // An L-shaped sheet: z = 0 for x < 10, then a wall. The median must not round the edge.
  const QuadMesh mesh = parametric_grid(20, 12, false, false, [](double u, double v) {
    const double s = u * 20;
    return glm::dvec3(std::min(s, 10.0), v * 12, std::max(0.0, s - 10.0));
  });
  std::vector<glm::vec4> faces = face_normals(mesh);
  const std::vector<glm::vec4> before = faces;
  SilentProgress progress;
  const auto neighbours = FaceNeighbours::build(mesh, progress);
  ASSERT_TRUE(filter_normals(*neighbours, {}, faces, progress));
  for (std::size_t f = 0; f < faces.size(); ++f)
    EXPECT_LT(angle_deg(glm::vec3(faces[f]), glm::vec3(before[f])), 6.0) << "face " << f;
}

TEST(NormalFilter, FaceWithoutAreaTakesTheNormalOfItsNeighbours) {
  QuadMesh mesh = parametric_grid(9, 9, false, false, [](double u, double v) { return glm::dvec3(9 * u, 9 * v, 0); });
  const auto q = mesh.quads[40];
  mesh.positions[q[1]] = mesh.positions[q[2]] = mesh.positions[q[3]] = mesh.positions[q[0]];
  std::vector<glm::vec4> faces = face_normals(mesh);
  ASSERT_EQ(faces[40], glm::vec4(0.0f));
  SilentProgress progress;
  const auto neighbours = FaceNeighbours::build(mesh, progress);
  ASSERT_TRUE(filter_normals(*neighbours, {}, faces, progress));
  EXPECT_LT(angle_deg(glm::vec3(faces[40]), {0, 0, 1}), 1e-3);
}

struct SphereErrors {
  double normal_deg = 0, offset = 0, spread = 0;
};

SphereErrors sphere_errors(const QuadMesh& mesh, const std::vector<glm::vec3>& normals, glm::dvec3 c, double radius) {
  SphereErrors e;
  double square = 0;
  const auto count = static_cast<double>(normals.size());
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const glm::dvec3 d = glm::dvec3(mesh.positions[v]) - c;
    const double r = glm::length(d) - radius;
    e.normal_deg += angle_deg(normals[v], glm::vec3(d)) / count;
    e.offset += r / count;
    square += r * r / count;
  }
  e.spread = std::sqrt(square - e.offset * e.offset);
  return e;
}

TEST(Smooth, ReducesNoiseOfASphereWithoutShrinkingIt) {
  const int n = 70;
  const double radius = 30;
  const glm::dvec3 c(35.1, 34.8, 35.05);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.1);  // voxel
  QuadMesh mesh = dual_mesh(n, 4, [&](glm::dvec3 p) { return radius - glm::length(p - c) + noise(random); });
  const auto before = sphere_errors(mesh, vertex_normals(mesh, face_normals(mesh)), c, radius);
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  const auto stats = smooth(mesh, normals, {}, progress);
  ASSERT_TRUE(stats);
  const auto after = sphere_errors(mesh, normals, c, radius);
  std::printf("angle %.3f -> %.3f deg, radius %+.4f +- %.4f -> %+.4f +- %.4f, moved %.4f max %.4f, residual %.3f deg\n",
              before.normal_deg, after.normal_deg, before.offset, before.spread, after.offset, after.spread,
              stats->mean_displacement_vox, stats->max_displacement_vox, stats->residual_angle_deg);
  EXPECT_LT(after.normal_deg, 0.4 * before.normal_deg);
  EXPECT_LT(after.spread, 0.6 * before.spread);
  EXPECT_LT(std::abs(after.offset - before.offset), 0.01);
  EXPECT_LE(stats->max_displacement_vox, 0.08 + 1e-5);
}

TEST(Smooth, FlattensNoisyClayAndKeepsTheDepthOfAWedge) {
  // Clay below a tilted plane with a groove of 90 degrees, 4 deep, across it; noise of 0.1 voxel.
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.1, -0.15, 1)), across = glm::normalize(glm::dvec3(1, 0.3, -0.055));
  const glm::dvec3 middle(29.8, 30.3, 30.1);
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, 0.1);
  const auto height = [&](glm::dvec3 p) { return glm::dot(p - middle, up); };
  const auto side = [&](glm::dvec3 p) { return std::abs(glm::dot(p - middle, across)); };
  QuadMesh mesh = dual_mesh(60, 4, [&](glm::dvec3 p) {
    const double inside_groove = (height(p) + 4 - side(p)) / std::sqrt(2.0);
    return std::min(-height(p), -inside_groove) + noise(random);
  });
  struct Figures {
    double flat_deg = 0, depth = 0;
  };
  const auto measure = [&](const std::vector<glm::vec3>& normals) {
    Figures f;
    int flat = 0, bottom = 0;
    for (std::size_t v = 0; v < normals.size(); ++v) {
      const glm::dvec3 p(mesh.positions[v]);
      if (glm::any(glm::greaterThan(glm::abs(p - middle), glm::dvec3(22)))) continue;
      if (side(p) > 8) f.flat_deg += angle_deg(normals[v], glm::vec3(up)), ++flat;
      if (side(p) < 0.6) f.depth -= height(p), ++bottom;
    }
    return Figures{f.flat_deg / flat, f.depth / bottom};
  };
  const Figures before = measure(vertex_normals(mesh, face_normals(mesh)));
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  ASSERT_TRUE(smooth(mesh, normals, {}, progress));
  const Figures after = measure(normals);
  std::printf("flat %.2f -> %.2f deg, depth %.3f -> %.3f\n", before.flat_deg, after.flat_deg, before.depth,
              after.depth);
  EXPECT_LT(after.flat_deg, 0.3 * before.flat_deg);
  EXPECT_GT(after.depth, before.depth - 0.15);
  EXPECT_GT(after.depth, 0.85 * 4);
}

TEST(Smooth, LeavesAPlaneWithinFloatPrecision) {
  const QuadMesh plane = parametric_grid(30, 30, false, false, [](double u, double v) {
    return glm::dvec3(900 + 30 * u, 900 + 30 * v, 500 + 9 * u + 6 * v);
  });
  QuadMesh mesh = plane;
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  ASSERT_TRUE(smooth(mesh, normals, {}, progress));
  const glm::vec3 expected = glm::normalize(glm::vec3(-0.3f, -0.2f, 1.0f));
  for (std::size_t v = 0; v < normals.size(); ++v) {
    EXPECT_LT(glm::length(mesh.positions[v] - plane.positions[v]), 1e-3f);
    EXPECT_LT(angle_deg(normals[v], expected), 0.02);
  }
}

TEST(Smooth, NeverMovesAVertexFurtherThanTheLimit) {
  QuadMesh mesh = torus(60, 40, 20, 8);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> noise(-0.6f, 0.6f);
  for (auto& p : mesh.positions) p += glm::vec3(noise(random), noise(random), noise(random));
  const QuadMesh start = mesh;
  SmoothOptions options;
  options.max_displacement_vox = 0.25f;
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  const auto stats = smooth(mesh, normals, options, progress);
  ASSERT_TRUE(stats);
  float largest = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    largest = std::max(largest, glm::length(mesh.positions[v] - start.positions[v]));
  EXPECT_LE(largest, 0.25f + 1e-5f);
  EXPECT_GT(largest, 0.249f);
  EXPECT_GT(stats->clamped_fraction, 0.05);
  EXPECT_NEAR(stats->max_displacement_vox, static_cast<double>(largest), 1e-6);
}

TEST(Smooth, SameBytesForOneTwoAndSevenThreads) {
  const QuadMesh start = quantised_sphere(64, 27, 4);
  std::vector<glm::vec3> first_positions, first_normals;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    QuadMesh mesh = start;
    std::vector<glm::vec3> normals;
    SilentProgress progress;
    ASSERT_TRUE(smooth(mesh, normals, {}, progress));
    if (first_positions.empty()) {
      first_positions = mesh.positions;
      first_normals = normals;
    }
    EXPECT_TRUE(test::same_bytes(mesh.positions, first_positions)) << threads;
    EXPECT_TRUE(test::same_bytes(normals, first_normals)) << threads;
  }
  set_thread_count(0);
}

TEST(Smooth, DoubledCornersBelongToThePolygon) {
  QuadMesh mesh = mesh_with_doubled_corner();
  const auto faces = face_normals(mesh);
  EXPECT_FLOAT_EQ(faces[0].w, 1.25f);  // unit square and the triangle (1,0) (1.5,.5) (1,1)
  EXPECT_EQ(glm::vec3(faces[0]), glm::vec3(0, 0, 1));
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  ASSERT_TRUE(smooth(mesh, normals, {}, progress));
  for (const auto& n : normals) EXPECT_LT(angle_deg(n, {0, 0, 1}), 1e-3);
}

TEST(Smooth, CancelLeavesTheMeshAsItWas) {
  class CancelHalfway : public Progress {
    void on_advance(std::int64_t done) override {
      if (done > 200000) cancel();
    }
  } progress;
  const QuadMesh start = quantised_sphere(64, 27, 4);
  QuadMesh mesh = start;
  std::vector<glm::vec3> normals;
  const auto stats = smooth(mesh, normals, {}, progress);
  ASSERT_FALSE(stats);
  EXPECT_EQ(stats.error().kind, ErrorKind::kCancelled);
  EXPECT_TRUE(test::same_bytes(mesh.positions, start.positions));
  EXPECT_TRUE(normals.empty());
}

TEST(Smooth, EmptyMeshIsFine) {
  QuadMesh mesh;
  mesh.build_incidence();
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  const auto stats = smooth(mesh, normals, {}, progress);
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->mean_displacement_vox, 0.0);
}

}  // namespace
}  // namespace dubsar
