#include "core/relief/occlusion/shared_sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>

#include "core/base/system/parallel.h"
#include "core/relief/occlusion/occlusion.h"
#include "core/relief/smoothing/smooth.h"
#include "tests/core/mesh/shape_meshes.h"

namespace dubsar {
namespace {
using namespace test;

/// A clay lump with a flat side that somebody has pressed wedges into, three-sided pits with sharp rims.
struct Tablet {
  QuadMesh mesh;
  std::vector<glm::vec3> normals;
  std::vector<Triangle> triangles;

  explicit Tablet(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    struct Wedge {
      glm::dvec3 tip;
      double angle, slope;
    };
    std::vector<Wedge> wedges;
    for (int k = 0; k < 26; ++k)
      wedges.push_back({{14 + 60 * unit(random), 14 + 60 * unit(random), 42 - 4 - 6 * unit(random)},
                        6.283 * unit(random),
                        0.7 + 0.8 * unit(random)});
    const double phase = 6 * unit(random);
    mesh = dual_mesh(88, 4, [&](glm::dvec3 p) {
      const glm::dvec3 q = glm::abs(p - glm::dvec3(44, 44, 26)) - glm::dvec3(36, 36, 12);
      double inside = 4 - glm::length(glm::max(q, glm::dvec3(0.0))) - std::min(std::max({q.x, q.y, q.z}), 0.0);
      for (const Wedge& w : wedges) {
        double pit = -1e9;
        for (int side = 0; side < 3; ++side) {
          const double a = w.angle + 2.0944 * side;
          const glm::dvec3 out(std::cos(a), std::sin(a), -w.slope);
          pit = std::max(pit, glm::dot(p - w.tip, out / glm::length(out)));
        }
        inside = std::min(inside, pit);
      }
      return inside + 0.05 * std::sin(1.9 * p.x + phase) * std::sin(2.3 * p.y) * std::sin(1.7 * p.z);
    });
    SilentProgress progress;
    EXPECT_TRUE(smooth(mesh, normals, {}, progress));
    triangles = split_quads(mesh);
  }
  std::vector<float> light(const OcclusionOptions& options) const {
    SilentProgress progress;
    const auto found = ambient_light({mesh.positions, normals, triangles}, options, progress);
    EXPECT_TRUE(found);
    return found.value_or(std::vector<float>{});
  }
};

struct Off {
  double rms = 0.0, mean = 0.0;
};
Off off(const std::vector<float>& found, const std::vector<float>& wanted) {
  double squares = 0, sum = 0;
  for (std::size_t v = 0; v < wanted.size(); ++v) {
    const double d = static_cast<double>(found[v]) - static_cast<double>(wanted[v]);
    squares += d * d;
    sum += d;
  }
  const auto count = static_cast<double>(wanted.size());
  return {std::sqrt(squares / count), sum / count};
}

TEST(SharedSky, PartsOfNineteenCoverTheSkyTogetherAndAlone) {
  std::vector<glm::vec3> all;
  for (int part = 0; part < 19; ++part) {
    const SkyRays sky = sky_rays_of_part(160, 19, part);
    ASSERT_EQ(sky.directions.size(), 9u);
    EXPECT_NEAR(sky.weight_sum / 9, 0.479256, 0.03);  // B(3/2, 3/4) / 2
    glm::dvec3 sum(0.0);
    for (const glm::vec3& d : sky.directions) sum += glm::dvec3(d) / 9.0;
    EXPECT_NEAR(sum.z, 0.5, 0.06);
    EXPECT_NEAR(std::hypot(sum.x, sum.y), 0.0, 0.08);
    all.insert(all.end(), sky.directions.begin(), sky.directions.end());
  }
  double closest = 4;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      closest = std::min(closest, std::acos(std::min(1.0, static_cast<double>(glm::dot(all[i], all[j])))));
  EXPECT_GT(closest, 0.02);  // nobody follows another's ray
}

TEST(SharedSky, NeighboursInAPlaneLookAtDifferentParts) {
  for (const glm::vec3 at : {glm::vec3(10.5f, 20.5f, 30.5f), glm::vec3(-3.5f, 0.5f, 700.5f)}) {
    std::set<int> parts;
    for (const glm::vec3 step :
         {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
          glm::vec3(1, 1, 0), glm::vec3(-1, 1, 0), glm::vec3(2, 0, 0), glm::vec3(0, 2, 0)}) {
      const int part = sky_part_at(at + step, 19);
      EXPECT_GE(part, 0);
      EXPECT_LT(part, 19);
      parts.insert(part);
    }
    EXPECT_EQ(parts.size(), 9u);
  }
}

TEST(SharedSky, EvenLightStaysAndNothingComesRoundAnEdge) {
  const QuadMesh mesh = parametric_grid(30, 2, false, false, [](double u, double v) {
    const double x = 30 * u - 15;
    return glm::dvec3(x, 4 * v, x > 0 ? -30 * x : 0);
  });
  std::vector<glm::vec3> normals;
  std::vector<float> even(mesh.positions.size(), 0.7f), two;
  for (const glm::vec3& p : mesh.positions) {
    normals.push_back(p.x > 0.1f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1));
    two.push_back(p.x > 0.1f ? 0.2f : 0.9f);
  }
  const std::vector<float> before = two;
  share_light(normals, split_quads(mesh), even);
  share_light(normals, split_quads(mesh), two);
  for (std::size_t v = 0; v < even.size(); ++v) {
    ASSERT_NEAR(even[v], 0.7f, 1e-6f);
    ASSERT_NEAR(two[v], before[v], 1e-6f);
  }
}

TEST(SharedSky, ANineteenthOfTheRaysGivesTheLightOfAll) {
  for (const unsigned seed : {40617u, 92233u}) {
    const Tablet tablet(seed);
    const std::vector<float> all = tablet.light({}), shared = tablet.light({.shared_by = 19});
    const std::vector<float> triangles = tablet.light({.engine = OcclusionEngine::kTriangles});
    const Off own = off(shared, all), before = off(all, triangles), after = off(shared, triangles);
    std::printf("seed %u, %zu vertices: shared - all %.4f (%.4f), all - triangles %.4f, shared - triangles %.4f\n",
                seed, all.size(), own.rms, own.mean, before.rms, after.rms);
    const auto dark = std::count_if(all.begin(), all.end(), [](float value) { return value < 0.8f; });
    EXPECT_GT(dark, static_cast<std::ptrdiff_t>(all.size() / 20)) << "nothing is dark: no test";
    EXPECT_LT(own.rms, 0.012) << seed;
    EXPECT_LT(std::abs(own.mean), 0.001) << seed;
    EXPECT_LT(after.rms, 0.02) << seed;
  }
}

TEST(SharedSky, OpenSurfacesAreExactlyOpen) {
  const QuadMesh ball = cube_sphere(30, 25, {400, 500, 600});
  SilentProgress progress;
  const auto light = ambient_light({ball.positions, vertex_normals(ball, face_normals(ball)), split_quads(ball)},
                                   {.shared_by = 19}, progress);
  ASSERT_TRUE(light);
  for (const float value : *light) EXPECT_EQ(value, 1.0f);
}

TEST(SharedSky, ThreadsBoxesAndEnginesChangeNothingButTheEngineALittle) {
  const Tablet tablet(5150);
  const OcclusionOptions options{.rays = 60, .radius_vox = 12, .shared_by = 19};
  const std::vector<float> first = tablet.light(options);
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    EXPECT_TRUE(tablet.light(options) == first) << threads;
  }
  set_thread_count(0);
  OcclusionOptions by_boxes = options;
  by_boxes.most_cells = 1.2e5;
  const std::vector<float> boxes = tablet.light(by_boxes);
  ASSERT_EQ(boxes.size(), first.size());
  EXPECT_LT(off(boxes, first).rms, 1e-4);  // a ray that grazes may be rounded to the other side, and is one of 9
  OcclusionOptions exact = options;
  exact.engine = OcclusionEngine::kTriangles;
  EXPECT_LT(off(first, tablet.light(exact)).rms, 0.02);
}

}  // namespace
}  // namespace dubsar
