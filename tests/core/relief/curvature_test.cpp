#include "core/relief/curvature/curvature.h"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "core/base/system/parallel.h"
#include "core/relief/curvature/shape_class.h"
#include "core/relief/smoothing/smooth.h"
#include "tests/core/mesh/shape_meshes.h"
#include "tests/core/relief/normals_of.h"

namespace dubsar {
namespace {
using namespace test;

Curvatures curvatures(const QuadMesh& mesh, const std::vector<glm::vec3>& normals,
                      CurvatureMethod method = CurvatureMethod::kFit) {
  SilentProgress progress;
  auto result = principal_curvatures(mesh, normals, method, progress);
  EXPECT_TRUE(result);
  return std::move(*result);
}

QuadMesh turned_inside_out(QuadMesh mesh) {
  for (auto& q : mesh.quads) std::swap(q[1], q[3]);
  mesh.build_incidence();
  return mesh;
}

QuadMesh open_cylinder(int nu, int nv, double radius, double length) {
  return parametric_grid(nu, nv, true, false, [=](double u, double v) {
    return glm::dvec3(radius * std::cos(2 * kPi * u), radius * std::sin(2 * kPi * u), length * v);
  });
}

/// z = (ax x^2 + ay y^2) / 2 on [-5, 5]^2 with unit steps, turned about z by `turn_deg`.
QuadMesh paraboloid(double ax, double ay, double turn_deg) {
  const double c = std::cos(turn_deg * kPi / 180), s = std::sin(turn_deg * kPi / 180);
  return parametric_grid(10, 10, false, false, [=](double u, double v) {
    const double x = 10 * u - 5, y = 10 * v - 5, xr = c * x + s * y, yr = c * y - s * x;
    return glm::dvec3(x, y, 0.5 * (ax * xr * xr + ay * yr * yr));
  });
}
constexpr std::size_t kParaboloidCentre = 5 * 11 + 5;

struct Moments {
  double mean_min = 0, mean_max = 0, worst = 0, rms = 0;
};
Moments moments(const Curvatures& k, double expected_min, double expected_max) {
  Moments m;
  for (std::size_t v = 0; v < k.k_min.size(); ++v) {
    const double low = static_cast<double>(k.k_min[v]), high = static_cast<double>(k.k_max[v]);
    m.mean_min += low / static_cast<double>(k.k_min.size());
    m.mean_max += high / static_cast<double>(k.k_min.size());
    const double error2 = std::pow(low - expected_min, 2) + std::pow(high - expected_max, 2);
    m.rms = std::hypot(m.rms, std::sqrt(error2 / (2.0 * static_cast<double>(k.k_min.size()))));
    m.worst = std::max({m.worst, std::abs(low - expected_min), std::abs(high - expected_max)});
  }
  return m;
}

TEST(Curvature, SphereIsOneOverRadiusEverywhere) {
  for (const auto method : {CurvatureMethod::kFit, CurvatureMethod::kPairs})
    for (const double radius : {5.0, 20.0, 60.0}) {
      const QuadMesh mesh = cube_sphere(static_cast<int>(1.6 * radius), radius);
      const Curvatures k = curvatures(mesh, normals_of(mesh), method);
      const Moments m = moments(k, 1 / radius, 1 / radius);
      EXPECT_NEAR(m.mean_min, 1 / radius, 0.03 / radius) << radius;
      EXPECT_NEAR(m.mean_max, 1 / radius, 0.03 / radius) << radius;
      EXPECT_LT(m.rms, 0.05 / radius) << radius;
      EXPECT_LT(m.worst, 0.3 / radius) << radius;  // beside the kinks of the grid at the edges of the cube
      for (std::size_t v = 0; v < k.k_min.size(); ++v) EXPECT_EQ(shape_of(shape_class(k.k_min[v], k.k_max[v])), 8);
    }
}

TEST(Curvature, SphereWithExactNormalsIsExact) {
  const QuadMesh mesh = cube_sphere(24, 15.0, {100, 200, 300});
  std::vector<glm::vec3> normals;
  for (const auto& p : mesh.positions) normals.push_back(glm::normalize(p - glm::vec3(100, 200, 300)));
  EXPECT_LT(moments(curvatures(mesh, normals), 1 / 15.0, 1 / 15.0).worst, 2e-5);
  EXPECT_LT(moments(curvatures(mesh, normals, CurvatureMethod::kPairs), 1 / 15.0, 1 / 15.0).worst, 2e-5);
}

TEST(Curvature, CavityIsACup) {
  const QuadMesh mesh = turned_inside_out(cube_sphere(32, 20));
  const Curvatures k = curvatures(mesh, normals_of(mesh));
  EXPECT_LT(moments(k, -0.05, -0.05).rms, 0.0015);
  for (std::size_t v = 0; v < k.k_min.size(); ++v) EXPECT_EQ(shape_of(shape_class(k.k_min[v], k.k_max[v])), 0);
}

TEST(Curvature, CylinderIsARidgeAndItsBoreARut) {
  const QuadMesh mesh = open_cylinder(63, 20, 10, 20);
  const Curvatures k = curvatures(mesh, normals_of(mesh));
  EXPECT_LT(moments(k, 0.0, 0.1).worst, 0.0005);
  const QuadMesh bore = turned_inside_out(mesh);
  const Curvatures kb = curvatures(bore, normals_of(bore));
  EXPECT_LT(moments(kb, -0.1, 0.0).worst, 0.0005);
  for (std::size_t v = 0; v < k.k_min.size(); ++v) {
    EXPECT_EQ(shape_of(shape_class(k.k_min[v], k.k_max[v])), 6);
    EXPECT_EQ(shape_of(shape_class(kb.k_min[v], kb.k_max[v])), 2);
  }
}

TEST(Curvature, SaddleIsFoundInEveryDirectionByTheFitButNotByDiagonals) {
  for (const double turn : {0.0, 17.0, 45.0, 80.0}) {
    const QuadMesh mesh = paraboloid(0.05, -0.05, turn);
    const Curvatures k = curvatures(mesh, normals_of(mesh));
    EXPECT_NEAR(k.k_min[kParaboloidCentre], -0.05f, 0.0015f) << turn;
    EXPECT_NEAR(k.k_max[kParaboloidCentre], 0.05f, 0.0015f) << turn;
    EXPECT_EQ(shape_of(shape_class(k.k_min[kParaboloidCentre], k.k_max[kParaboloidCentre])), 4);
  }
  const QuadMesh across = paraboloid(0.05, -0.05, 0.0);  // diagonals run along the asymptotes
  const Curvatures pairs = curvatures(across, normals_of(across), CurvatureMethod::kPairs);
  EXPECT_NEAR(pairs.k_max[kParaboloidCentre], 0.0f, 0.005f);
  const QuadMesh along = paraboloid(0.05, -0.05, 45.0);
  const Curvatures good = curvatures(along, normals_of(along), CurvatureMethod::kPairs);
  EXPECT_NEAR(good.k_max[kParaboloidCentre], 0.05f, 0.002f);
  EXPECT_NEAR(good.k_min[kParaboloidCentre], -0.05f, 0.002f);
}

TEST(Curvature, EllipticParaboloidAtItsApex) {
  const QuadMesh mesh = paraboloid(-0.08, -0.02, 30.0);  // z down: convex seen from above
  const Curvatures k = curvatures(mesh, normals_of(mesh));
  EXPECT_NEAR(k.k_min[kParaboloidCentre], 0.02f, 0.001f);
  EXPECT_NEAR(k.k_max[kParaboloidCentre], 0.08f, 0.003f);
}

TEST(Curvature, TorusHasDomesOutsideSaddleRidgesInsideAndRidgesOnTop) {
  const double tube = 12, ring = 36;
  const int nu = 240, nv = 80;
  const QuadMesh mesh = torus(nu, nv, ring, tube);
  const Curvatures k = curvatures(mesh, normals_of(mesh));
  double worst = 0;
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const auto v = static_cast<std::size_t>(j * nu + i);
      const double cosine = std::cos(2 * kPi * j / nv), around = cosine / (ring + tube * cosine);
      worst = std::max({worst, std::abs(static_cast<double>(k.k_min[v]) - around),
                        std::abs(static_cast<double>(k.k_max[v]) - 1 / tube)});
      const int shape = shape_of(shape_class(k.k_min[v], k.k_max[v]));
      if (j == 0) {
        EXPECT_EQ(shape, 7);
      }
      if (j == nv / 2) {
        EXPECT_EQ(shape, 5);
      }
      if (j == nv / 4) {
        EXPECT_EQ(shape, 6);
      }
    }
  EXPECT_LT(worst, 0.0006);
}

TEST(Curvature, DoesNotDependOnTheDirectionOfTheMesh) {
  QuadMesh mesh = torus(60, 24, 20, 7);
  const Curvatures k = curvatures(mesh, normals_of(mesh));
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 1.234, glm::normalize(glm::dvec3(1, -2, 0.7)));
  for (auto& p : mesh.positions) p = glm::vec3(turn * glm::dvec4(glm::dvec3(p), 1.0));
  const Curvatures turned = curvatures(mesh, normals_of(mesh));
  for (std::size_t v = 0; v < k.k_min.size(); ++v) {
    EXPECT_NEAR(k.k_min[v], turned.k_min[v], 2e-5f);
    EXPECT_NEAR(k.k_max[v], turned.k_max[v], 2e-5f);
  }
}

TEST(Curvature, DoubledCornerCountsWithTheMeanOfItsVertices) {
  // A cylinder patch whose middle vertex is split in two, symmetrically about its old place.
  QuadMesh mesh = open_cylinder(40, 6, 8, 7);
  const QuadMesh plain = mesh;
  const std::uint32_t middle = 3 * 40 + 5, twin = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(mesh.positions[middle] + glm::vec3(0, 0, 0.2f));
  mesh.positions[middle] -= glm::vec3(0, 0, 0.2f);
  for (std::uint32_t q = 0; q < mesh.quads.size(); ++q)
    for (std::uint8_t c = 0; c < 4; ++c)
      if (mesh.quads[q][c] == middle) mesh.doubled.push_back({q, twin, c});
  mesh.build_incidence();
  std::vector<glm::vec3> normals = normals_of(plain);
  const Curvatures before = curvatures(plain, normals);
  normals.push_back(normals[middle]);
  const Curvatures after = curvatures(mesh, normals);
  for (const std::uint32_t v : {middle, middle - 1, middle + 1}) {
    EXPECT_NEAR(after.k_min[v], before.k_min[v], 1e-6f);
    EXPECT_NEAR(after.k_max[v], before.k_max[v], 1e-6f);
  }
  EXPECT_NEAR(after.k_max[twin], before.k_max[middle], 1e-6f);
}

TEST(Curvature, DegenerateVerticesAreFlat) {
  QuadMesh mesh = parametric_grid(6, 6, false, false, [](double, double) { return glm::dvec3(1, 2, 3); });
  const std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0, 0, -1));
  for (const auto method : {CurvatureMethod::kFit, CurvatureMethod::kPairs}) {
    const Curvatures k = curvatures(mesh, normals, method);
    for (std::size_t v = 0; v < k.k_min.size(); ++v) {
      EXPECT_EQ(k.k_min[v], 0.0f);
      EXPECT_EQ(k.k_max[v], 0.0f);
    }
  }
}

TEST(Curvature, MinimumNeverExceedsMaximumAndThreadsDoNotMatter) {
  QuadMesh mesh = torus(200, 80, 40, 13);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> noise(-0.4f, 0.4f);
  for (auto& p : mesh.positions) p += glm::vec3(noise(random), noise(random), noise(random));
  const auto normals = normals_of(mesh);
  for (const auto method : {CurvatureMethod::kFit, CurvatureMethod::kPairs}) {
    set_thread_count(1);
    const Curvatures one = curvatures(mesh, normals, method);
    for (std::size_t v = 0; v < one.k_min.size(); ++v) ASSERT_LE(one.k_min[v], one.k_max[v]);
    for (const int threads : {2, 7}) {
      set_thread_count(threads);
      const Curvatures many = curvatures(mesh, normals, method);
      EXPECT_EQ(std::memcmp(one.k_min.data(), many.k_min.data(), one.k_min.size() * sizeof(float)), 0);
      EXPECT_EQ(std::memcmp(one.k_max.data(), many.k_max.data(), one.k_max.size() * sizeof(float)), 0);
    }
  }
  set_thread_count(0);
}

/// Fraction of vertices whose shape angle differs by less than 22.5 degrees (one class) from the true one, after
/// extraction with 4-bit offsets and smoothing. `select` picks vertices away from open ends.
double shape_agreement(int n, const std::function<double(glm::dvec3)>& field,
                       const std::function<glm::dvec2(glm::dvec3)>& truth,
                       const std::function<bool(glm::dvec3)>& select, Moments& out) {
  QuadMesh mesh = dual_mesh(n, 4, field);
  std::vector<glm::vec3> normals;
  SilentProgress progress;
  EXPECT_TRUE(smooth(mesh, normals, {}, progress));
  const Curvatures k = curvatures(mesh, normals);
  std::int64_t good = 0, all = 0;
  for (std::size_t v = 0; v < k.k_min.size(); ++v) {
    const glm::dvec3 p(mesh.positions[v]);
    if (!select(p)) continue;
    const glm::dvec2 t = truth(p);
    const double low = static_cast<double>(k.k_min[v]), high = static_cast<double>(k.k_max[v]);
    const double difference = std::abs(std::atan2(low, high) - std::atan2(t.x, t.y)) * 180 / kPi;
    good += difference < 22.5;
    ++all;
    out.mean_min += low;
    out.mean_max += high;
  }
  out.mean_min /= static_cast<double>(all);
  out.mean_max /= static_cast<double>(all);
  return static_cast<double>(good) / static_cast<double>(all);
}

TEST(Curvature, ExtractedAndSmoothedSphereCylinderAndSaddleKeepTheirShape) {
  const glm::dvec3 c(29.6, 30.1, 29.8);
  const auto inner = [&](glm::dvec3 p) { return glm::all(glm::lessThan(glm::abs(p - c), glm::dvec3(24.0))); };
  Moments sphere, cylinder, saddle;
  const double good_sphere = shape_agreement(
      60, [&](glm::dvec3 p) { return 20 - glm::length(p - c); }, [](glm::dvec3) { return glm::dvec2(0.05, 0.05); },
      [](glm::dvec3) { return true; }, sphere);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.2, 1.0));
  const double good_cylinder = shape_agreement(
      60, [&](glm::dvec3 p) { return 10 - glm::length(glm::cross(p - c, axis)); },
      [](glm::dvec3) { return glm::dvec2(0.0, 0.1); }, [&](glm::dvec3 p) { return std::abs(p.z - c.z) < 20; },
      cylinder);
  const double good_saddle = shape_agreement(
      60,
      [&](glm::dvec3 p) {
        p -= c;
        return 0.025 * (p.x * p.x - p.y * p.y) - p.z;
      },
      [](glm::dvec3) { return glm::dvec2(-0.05, 0.05); },
      [&](glm::dvec3 p) { return inner(p) && std::hypot(p.x - c.x, p.y - c.y) < 6; }, saddle);
  std::printf("sphere %.4f (%.4f %.4f)  cylinder %.4f (%.4f %.4f)  saddle %.4f (%.4f %.4f)\n", good_sphere,
              sphere.mean_min, sphere.mean_max, good_cylinder, cylinder.mean_min, cylinder.mean_max, good_saddle,
              saddle.mean_min, saddle.mean_max);
  EXPECT_GT(good_sphere, 0.96);
  EXPECT_GT(good_cylinder, 0.99);
  EXPECT_GT(good_saddle, 0.92);
  EXPECT_NEAR(0.5 * (sphere.mean_min + sphere.mean_max), 0.05, 0.001);
  EXPECT_NEAR(cylinder.mean_max, 0.1, 0.004);
  EXPECT_NEAR(cylinder.mean_min, 0.0, 0.006);
}

TEST(ShapeClass, CanonicalShapesHitTheCentresOfTheirClasses) {
  EXPECT_EQ(shape_of(shape_class(-0.1f, -0.1f)), 0);
  EXPECT_EQ(shape_of(shape_class(-0.1f, 0.0f)), 2);
  EXPECT_EQ(shape_of(shape_class(-0.1f, -0.0f)), 2);
  EXPECT_EQ(shape_of(shape_class(-0.1f, 0.1f)), 4);
  EXPECT_EQ(shape_of(shape_class(0.0f, 0.1f)), 6);
  EXPECT_EQ(shape_of(shape_class(0.1f, 0.1f)), 8);
  // A quarter of a class (5.6 degrees) to either side stays in the class.
  for (int s = 0; s <= 8; s += 2)
    for (const double shift : {-0.45, 0.45}) {
      const double phi = (std::clamp(22.5 * (s + shift), 0.0, 180.0) - 135) * kPi / 180;
      EXPECT_EQ(shape_of(shape_class(static_cast<float>(0.2 * std::sin(phi)), static_cast<float>(0.2 * std::cos(phi)))),
                s);
    }
}

TEST(ShapeClass, DoublingTheRadiusIsTwoStepsLess) {
  for (const float k : {1.0f, 0.5f, 0.25f, 0.125f, 0.0625f}) {
    const int i = curvedness_step_of(shape_class(0.0f, k)), half = curvedness_step_of(shape_class(0.0f, k / 2));
    EXPECT_EQ(i - half, 2);
  }
  EXPECT_EQ(curvedness_step_of(shape_class(0.0f, kSmallestCurvedness)), 0);
  EXPECT_EQ(curvedness_step_of(shape_class(0.0f, 1.4142f)), 13);
}

TEST(ShapeClass, EndsOfTheScaleAndOddValues) {
  EXPECT_EQ(shape_class(0.0f, 0.0f), 0);
  EXPECT_EQ(shape_class(0.0f, 0.8f * kSmallestCurvedness), 0);
  EXPECT_EQ(curvedness_step_of(shape_class(0.0f, 0.85f * kSmallestCurvedness)), 0);
  EXPECT_EQ(shape_class(1e30f, 1e30f), kShapeClasses - 1);
  EXPECT_EQ(shape_class(-1e30f, -1e30f), 1 + 9 * 13);
  EXPECT_EQ(shape_class(NAN, 0.1f), 0);
  EXPECT_EQ(shape_class(-INFINITY, 0.1f), 0);
  EXPECT_EQ(shape_class(0.3f, -0.1f), shape_class(-0.1f, 0.3f));
}

TEST(ShapeClass, TurningInsideOutMirrorsTheShapesAndKeepsTheStep) {
  std::mt19937 random(11);
  std::normal_distribution<float> k(0.0f, 0.2f);
  std::array<int, kShapeClasses> seen{};
  for (int n = 0; n < 200000; ++n) {
    const float a = k(random) * (n % 3 ? 1.0f : 0.1f), b = k(random) * (n % 3 ? 1.0f : 0.1f);
    const std::uint8_t forward = shape_class(std::min(a, b), std::max(a, b));
    const std::uint8_t mirrored = shape_class(std::min(-a, -b), std::max(-a, -b));
    ++seen[forward];
    ASSERT_LT(forward, kShapeClasses);
    if (forward == 0) {
      ASSERT_EQ(mirrored, 0);
      continue;
    }
    ASSERT_EQ(curvedness_step_of(forward), curvedness_step_of(mirrored));
    ASSERT_EQ(shape_of(forward), 8 - shape_of(mirrored)) << a << " " << b;
  }
  EXPECT_GT(std::count_if(seen.begin(), seen.end(), [](int c) { return c > 0; }), 110);
}

TEST(ShapeClass, ClassesOfAMeshAreThoseOfItsVertices) {
  const std::vector<float> low{-0.1f, 0.0f, 0.05f}, high{0.1f, 0.0f, 0.05f};
  const std::vector<std::uint8_t> expected{shape_class(-0.1f, 0.1f), 0, shape_class(0.05f, 0.05f)};
  EXPECT_EQ(shape_classes(low, high), expected);
}

}  // namespace
}  // namespace dubsar
