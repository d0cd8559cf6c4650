#include "core/relief/occlusion/occlusion.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "core/base/system/parallel.h"
#include "core/relief/smoothing/smooth.h"
#include "tests/core/mesh/shape_meshes.h"
#include "tests/core/relief/normals_of.h"

namespace dubsar {
namespace {
using namespace test;

std::vector<float> light(const QuadMesh& mesh, const OcclusionOptions& options = {},
                         const std::vector<PartitionId>& bodies = {}) {
  SilentProgress progress;
  auto result = ambient_light({mesh.positions, normals_of(mesh), split_quads(mesh), bodies}, options, progress);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : std::vector<float>{};
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void append(QuadMesh& mesh, const QuadMesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (auto q : other.quads) {
    for (auto& v : q) v += base;
    mesh.quads.push_back(q);
  }
  mesh.build_incidence();
}

QuadMesh inside_out(QuadMesh mesh) {
  for (auto& q : mesh.quads) std::swap(q[1], q[3]);
  mesh.build_incidence();
  return mesh;
}

/// Square of half width `half` in the plane z = height; air above (up) or below.
QuadMesh sheet(double half, int n, double height, bool up) {
  QuadMesh mesh = parametric_grid(n, n, false, false, [=](double u, double v) {
    return glm::dvec3(half * (2 * u - 1), half * (2 * v - 1), height);
  });
  return up ? mesh : inside_out(mesh);
}

TEST(SkyRays, WeightsHaveTheGoldenMean) {
  const SkyRays sky = sky_rays_of_part(160, 1, 0);
  EXPECT_NEAR(sky.weight_sum / 160, 0.479329, 5e-7);
  EXPECT_NEAR(sky_rays_of_part(20000, 1, 0).weight_sum / 20000, 0.479256, 5e-6);  // B(3/2, 3/4) / 2
}

TEST(SkyRays, CoverTheHemisphereEvenly) {
  const SkyRays sky = sky_rays_of_part(160, 1, 0);
  glm::dvec3 sum(0.0);
  for (const auto& d : sky.directions) {
    EXPECT_NEAR(glm::length(d), 1.0f, 1e-6f);
    EXPECT_GT(d.z, 0.0f);
    sum += glm::dvec3(d) / 160.0;
  }
  EXPECT_NEAR(sum.z, 0.5, 1e-6);
  EXPECT_NEAR(sum.x, 0.0, 0.01);
  EXPECT_NEAR(sum.y, 0.0, 0.01);
  double closest = 4;
  for (std::size_t i = 0; i < 160; ++i)
    for (std::size_t j = 0; j < i; ++j)
      closest = std::min(closest, std::acos(static_cast<double>(glm::dot(sky.directions[i], sky.directions[j]))));
  EXPECT_GT(closest, 0.12);  // 160 equal caps of the hemisphere have a radius of 0.112
}

TEST(Occlusion, PlaneIsExactlyOpen) {
  QuadMesh mesh = parametric_grid(40, 40, false, false, [](double u, double v) {
    return glm::dvec3(700 + 40 * u, 300 + 40 * v, 500 + 13 * u - 21 * v);
  });
  for (const float value : light(mesh)) EXPECT_EQ(value, 1.0f);
}

TEST(Occlusion, ConvexBodiesAreExactlyOpen) {
  for (const float value : light(cube_sphere(30, 25, {400, 500, 600}))) EXPECT_EQ(value, 1.0f);
  const QuadMesh egg = dual_mesh(48, 4, [](glm::dvec3 p) {
    p -= glm::dvec3(24.2, 23.7, 24.1);
    return 18 - glm::length(p * glm::dvec3(1.0, 1.3, 0.9));
  });
  QuadMesh smoothed = egg;
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  ASSERT_TRUE(smooth(smoothed, normals, {}, progress));
  const auto value = ambient_light({smoothed.positions, normals, split_quads(smoothed)}, {}, progress);
  ASSERT_TRUE(value);
  EXPECT_GT(*std::min_element(value->begin(), value->end()), 0.99f);
  EXPECT_GT(mean(*value), 0.9999);
}

TEST(Occlusion, InsideABallItIsLinearInTheRadius) {
  for (const double rho : {10.0, 20.0, 30.0}) {
    const QuadMesh cave = inside_out(cube_sphere(24, rho, {100, 90, 80}));
    OcclusionOptions options;
    options.offset_vox = 0.01f;
    const std::vector<float> values = light(cave, options);
    const double expected = 0.52106 * 2 * rho / 64;
    EXPECT_NEAR(mean(values), expected, 0.004) << rho;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    EXPECT_LT(*high - *low, 0.015f);
    EXPECT_NEAR(mean(light(cave)), expected, 0.008) << rho;
  }
}

TEST(Occlusion, ParallelGapAgreesWithQuadrature) {
  for (const double gap : {2.0, 6.0, 20.0, 50.0}) {
    QuadMesh mesh = sheet(80, 8, 0, true);
    append(mesh, sheet(80, 8, gap, false));
    OcclusionOptions options;
    options.offset_vox = 0.01f;
    const float found = light(mesh, options)[4 * 9 + 4];
    constexpr int kSteps = 200000;
    double taken = 0, all = 0;
    for (int i = 0; i < kSteps; ++i) {  // over solid angle: z uniform
      const double z = (i + 0.5) / kSteps, w = std::sqrt(1 - z * z) * std::sqrt(z);
      all += w;
      taken += w * std::max(0.0, 1 - gap / z / 64);
    }
    EXPECT_NEAR(static_cast<double>(found), 1 - taken / all, 0.008) << gap;  // half a voxel of 64
    options.engine = OcclusionEngine::kTriangles;
    EXPECT_NEAR(static_cast<double>(light(mesh, options)[4 * 9 + 4]), 1 - taken / all, 0.004) << gap;
  }
}

TEST(Occlusion, RightAngledGrooveAgreesWithRayPlaneIntersection) {
  // Two half planes that meet at x = 0: z = |x|, air above.
  const QuadMesh mesh = parametric_grid(200, 1, false, false, [](double u, double v) {
    const double x = 200 * u - 100;
    return glm::dvec3(x, 300 * v - 150, std::abs(x));
  });
  // A vertex in the middle of the right slope, not part of the triangles.
  std::vector<glm::vec3> positions = mesh.positions, normals = normals_of(mesh);
  const glm::vec3 n = glm::normalize(glm::vec3(-1, 0, 1));
  std::vector<double> heights{2, 5, 12, 30};
  for (const double h : heights) {
    positions.emplace_back(h, 0, h);
    normals.push_back(n);
  }
  SilentProgress progress;
  const auto values = ambient_light({positions, normals, split_quads(mesh)}, {}, progress);
  ASSERT_TRUE(values);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    // Dense sampling of directions; the left slope is the plane x + z = 0.
    double taken = 0, all = 0;
    for (int a = 0; a < 600; ++a)
      for (int b = 0; b < 600; ++b) {
        const double z = (a + 0.5) / 600, phi = 2 * kPi * (b + 0.5) / 600, r = std::sqrt(1 - z * z);
        const double w = r * std::sqrt(z);
        // frame: n, e = (1, 0, 1) / sqrt 2 up the slope, y along the groove
        const double dx = (-z + r * std::cos(phi)) / std::sqrt(2.0), dz = (z + r * std::cos(phi)) / std::sqrt(2.0);
        all += w;
        if (dx + dz < 0) taken += w * std::max(0.0, 1 - 2 * heights[i] / -(dx + dz) / 64);
      }
    EXPECT_NEAR(static_cast<double>((*values)[mesh.positions.size() + i]), 1 - taken / all, 0.012) << heights[i];
  }
}

TEST(Occlusion, UnderTheSurfaceItIsDark) {
  const QuadMesh mesh = cube_sphere(20, 15);
  std::vector<glm::vec3> positions = mesh.positions, normals = normals_of(mesh);
  positions.emplace_back(3.0f, 2.0f, -1.0f);
  normals.emplace_back(0, 0, 1);
  SilentProgress progress;
  const auto values = ambient_light({positions, normals, split_quads(mesh)}, {}, progress);
  ASSERT_TRUE(values);
  EXPECT_NEAR(values->back(), 0.0f, 1e-5f);
}

TEST(Occlusion, BodiesAreLitAloneAndOtherwiseTheEnclosedBodyIsDark) {
  QuadMesh mesh = cube_sphere(24, 20);
  const std::size_t body = mesh.positions.size();
  append(mesh, inside_out(cube_sphere(24, 23)));  // inner wall, gap of 3
  const std::size_t wall = mesh.positions.size();
  append(mesh, cube_sphere(24, 30));  // outer wall
  std::vector<PartitionId> bodies;
  for (const Triangle& t : split_quads(mesh)) bodies.push_back(t[0] < body ? 2 : 1);
  const auto apart = light(mesh, {}, bodies), together = light(mesh);
  for (std::size_t v = 0; v < body; ++v) {
    EXPECT_EQ(apart[v], 1.0f);
    EXPECT_LT(together[v], 0.15f);
  }
  for (std::size_t v = body; v < wall; ++v) EXPECT_LT(together[v], apart[v]);
  for (std::size_t v = wall; v < mesh.positions.size(); ++v) EXPECT_EQ(apart[v], together[v]);
}

QuadMesh rough_scene(int quarter_turns = 0) {
  const glm::dvec3 c(23.5);
  return dual_mesh(48, 4, [=](glm::dvec3 p) {
    for (int i = 0; i < quarter_turns; ++i) p = glm::dvec3(p.y, 47 - p.x, p.z);
    const double bumps = 1.2 * std::sin(0.9 * p.x) * std::sin(0.8 * p.y + 1) * std::sin(0.7 * p.z);
    const double d = glm::length(p - c) + bumps;
    return std::max(std::min(22 - d, d - 18), 13 - d);
  });
}

TEST(Occlusion, MarchingAgreesWithTheTriangles) {
  // Dents with sharp edges in a lump, and a hollow that is seen into: what tablets and envelopes have. The clay between
  // dents is two voxels or more: what is thinner than a cell has no two sides in it.
  for (const unsigned seed : {3301u, 8128u}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1, 1), size(3, 7);
    std::vector<std::pair<glm::dvec3, double>> dents;
    while (dents.size() < 24) {
      const glm::dvec3 way(place(random), place(random), place(random));
      const glm::dvec3 at = 32.0 + way / glm::length(way * glm::dvec3(1.0, 1.1, 1.6)) * 24.0;
      const double reach = size(random);
      if (std::all_of(dents.begin(), dents.end(), [&](const auto& dent) {
            const glm::dvec3 apart = glm::abs(dent.first - at);
            return apart.x + apart.y + apart.z > dent.second + reach + 4;
          }))
        dents.emplace_back(at, reach);
    }
    QuadMesh mesh = dual_mesh(64, 4, [&](glm::dvec3 p) {
      double inside = 24 - glm::length((p - 32.0) * glm::dvec3(1.0, 1.1, 1.6));
      inside = std::min(inside, glm::length(p - 32.0) - 6);
      inside = std::min(inside, std::hypot(p.x - 32.0, p.y - 32.0) - (p.z > 32 ? 4.0 : -4.0));
      for (const auto& [at, reach] : dents) {
        const glm::dvec3 d = glm::abs(p - at);
        inside = std::min(inside, d.x + d.y + d.z - reach);
      }
      return inside;
    });
    std::vector<glm::vec3> normals;
    SilentProgress progress;
    ASSERT_TRUE(smooth(mesh, normals, {}, progress));
    const auto triangles = split_quads(mesh);
    OcclusionOptions options{.rays = 96, .radius_vox = 40};
    const auto marched = ambient_light({mesh.positions, normals, triangles}, options, progress);
    options.engine = OcclusionEngine::kTriangles;
    const auto exact = ambient_light({mesh.positions, normals, triangles}, options, progress);
    ASSERT_TRUE(marched && exact);
    double squares = 0, sum = 0;
    for (std::size_t v = 0; v < exact->size(); ++v) {
      const double difference = (*marched)[v] - (*exact)[v];
      squares += difference * difference;
      sum += difference;
    }
    const auto count = static_cast<double>(exact->size());
    EXPECT_GT(count, 5000);
    EXPECT_LT(mean(*exact), 0.9) << "nothing is dark: no test";
    EXPECT_LT(std::sqrt(squares / count), 0.02) << seed;
    EXPECT_LT(std::abs(sum / count), 0.005) << seed;
  }
}

TEST(Occlusion, AllVectorsGiveTheSameBits) {
  const QuadMesh mesh = rough_scene();
  std::vector<float> first;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const auto values = light(mesh, {.rays = 24});
    if (first.empty()) first = values;
    EXPECT_TRUE(values == first) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(Occlusion, BoxByBoxItIsTheSame) {
  const QuadMesh mesh = rough_scene();
  const auto whole = light(mesh, {.rays = 40, .radius_vox = 9});
  for (const double cells : {6e4, 2e4}) {
    const auto parts = light(mesh, {.rays = 40, .radius_vox = 9, .most_cells = cells});
    ASSERT_EQ(parts.size(), whole.size());
    for (std::size_t v = 0; v < whole.size(); ++v) ASSERT_NEAR(parts[v], whole[v], 1e-4) << v << ' ' << cells;
  }
}

TEST(Occlusion, TurningTheVolumeKeepsTheLight) {
  OcclusionOptions options;
  options.rays = 60;
  const auto straight = light(rough_scene(0), options), turned = light(rough_scene(1), options);
  EXPECT_NEAR(mean(straight), mean(turned), 0.003);
}

TEST(Occlusion, GrowsDarkerWithTheRadius) {
  const QuadMesh mesh = rough_scene();
  std::vector<float> before(mesh.positions.size(), 1.0f);
  for (const float radius : {4.0f, 16.0f, 64.0f, 200.0f}) {
    OcclusionOptions options;
    options.radius_vox = radius;
    options.rays = 24;
    const auto now = light(mesh, options);
    for (std::size_t v = 0; v < now.size(); ++v) ASSERT_LE(now[v], before[v] + 1e-6f);
    EXPECT_LT(mean(now), mean(before));
    before = now;
  }
}

TEST(Occlusion, SameValuesForOneTwoAndSevenThreadsInSixtyFourSteps) {
  const QuadMesh mesh = rough_scene();
  const auto normals = normals_of(mesh);
  const auto triangles = split_quads(mesh);
  SilentProgress progress;
  OcclusionOptions options;
  options.rays = 60;
  std::vector<float> first;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    const auto values = ambient_light({mesh.positions, normals, triangles}, options, progress);
    ASSERT_TRUE(values);
    if (first.empty()) first = *values;
    EXPECT_TRUE(*values == first) << threads;
  }
  set_thread_count(0);
  const auto steps = ambient_occlusion({mesh.positions, normals, triangles}, options, progress);
  ASSERT_TRUE(steps);
  for (std::size_t v = 0; v < first.size(); ++v) {
    ASSERT_LE((*steps)[v], 63);
    ASSERT_NEAR(static_cast<float>((*steps)[v]), 63 * first[v], 0.5001f);
  }
}

TEST(Occlusion, RefusesMissingVerticesAndTakesEmptyAndBrokenInput) {
  SilentProgress progress;
  const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, normals(3, glm::vec3(0, 0, 1));
  const std::vector<Triangle> bad{{0, 1, 3}}, good{{0, 1, 2}};
  const auto refused = ambient_light({positions, normals, bad}, {}, progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kBadData);
  const auto empty = ambient_light({}, {}, progress);
  ASSERT_TRUE(empty);
  EXPECT_TRUE(empty->empty());
  const auto no_triangles = ambient_light({positions, normals, {}}, {}, progress);
  ASSERT_TRUE(no_triangles);
  EXPECT_EQ(*no_triangles, std::vector<float>(3, 1.0f));
  const std::vector<glm::vec3> broken(3, glm::vec3(NAN));
  const auto not_finite = ambient_light({positions, broken, good}, {}, progress);
  ASSERT_TRUE(not_finite);
  EXPECT_EQ(*not_finite, std::vector<float>(3, 1.0f));
}

TEST(Occlusion, StopsWhenCancelled) {
  class CancelSoon : public Progress {
    void on_advance(std::int64_t done) override {
      if (done > 100000) cancel();
    }
  } progress;
  const QuadMesh mesh = rough_scene();
  const auto values = ambient_light({mesh.positions, normals_of(mesh), split_quads(mesh)}, {}, progress);
  ASSERT_FALSE(values);
  EXPECT_EQ(values.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
