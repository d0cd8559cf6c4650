// Blurred bodies whose true surface is known in closed form: what moves take back of rounding and of noise.
#include "core/relief/smoothing/fair_moves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "core/base/system/parallel.h"
#include "core/extract/extract.h"
#include "core/volume/carried_source.h"

namespace dubsar {
namespace {

constexpr int kSize = 44;
constexpr double kBlur = 0.9;
const glm::dvec3 kMiddle(21.6, 22.2, 21.9);

/// A ball of radius r blurred by a Gauss of deviation s, at a distance d from its middle: exact.
double blurred_ball(double r, double s, double d) {
  const double a = s * std::numbers::sqrt2, e = std::max(d, 1e-6);
  return 0.5 * (std::erf((r - e) / a) + std::erf((r + e) / a)) -
         s / (e * std::sqrt(2.0 * std::numbers::pi)) *
             (std::exp(-(r - e) * (r - e) / (a * a)) - std::exp(-(r + e) * (r + e) / (a * a)));
}

template <class Density>
Volume<float> volume_of(const Density& density) {
  Volume<float> volume({kSize, kSize, kSize});
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) volume.row(y, z)[x] = static_cast<float>(density(glm::dvec3(x, y, z) - kMiddle));
  return volume;
}

QuadMesh mesh_of(SlabSource& source) {
  SilentProgress progress;
  return build_quad_mesh(sample_surface(source, {0.5f, 10, true}, progress).value(), progress).value();
}

QuadMesh faired(const Volume<float>& volume, float growth) {
  VolumeSource source(volume);
  SilentProgress progress;
  const QuadMesh mesh = mesh_of(source);
  const std::vector<glm::vec3> moves = fair_moves(mesh, {.growth = growth}, progress).value();
  CarriedSource carried(source, mesh.positions, moves, 1.0f);
  return mesh_of(carried);
}

struct Radii {
  double mean = 0.0, spread = 0.0;
};
Radii radii(const QuadMesh& mesh) {
  double sum = 0.0, squares = 0.0;
  for (const glm::vec3& p : mesh.positions) {
    const double r = glm::length(glm::dvec3(p) - kMiddle);
    sum += r;
    squares += r * r;
  }
  const auto count = static_cast<double>(mesh.positions.size());
  return {sum / count, std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)))};
}

/// Noise that hangs together over some two voxels, of deviation 1.
std::vector<double> noise(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(static_cast<std::size_t>(kSize) * kSize * kSize);
  for (double& v : values) v = normal(random);
  const std::size_t steps[] = {1, kSize, static_cast<std::size_t>(kSize) * kSize};
  for (const std::size_t step : steps) {
    const std::vector<double> from = values;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] =
          0.5 * from[i] + 0.25 * (from[(i + step) % from.size()] + from[(i + from.size() - step) % from.size()]);
  }
  double squares = 0.0;
  for (const double v : values) squares += v * v;
  for (double& v : values) v /= std::sqrt(squares / static_cast<double>(values.size()));
  return values;
}

// Vertices lie on chords of the ball, some .02 inside, before and after. The law is that of a small curvature: terms of
// (blur / radius)^2, 1 %, and the edges of a grid that the surface is made of leave the rest.
TEST(FairMoves, BlurTakesItsVarianceTimesTheCurvatureOffABallAndGrowthGivesItBack) {
  for (const double blur : {0.6, 0.9})
    for (const double radius : {9.0, 13.0}) {
      const Volume<float> volume =
          volume_of([&](const glm::dvec3& p) { return blurred_ball(radius, blur, glm::length(p)); });
      VolumeSource source(volume);
      const double before = radii(mesh_of(source)).mean, taken = blur * blur / radius;
      EXPECT_NEAR(before, radius - taken, 0.03);
      EXPECT_NEAR(radii(faired(volume, static_cast<float>(blur * blur))).mean - before, taken, 0.06 * taken)
          << blur << " " << radius;
      EXPECT_NEAR(radii(faired(volume, 0.0f)).mean, before, 0.003) << blur << " " << radius;
    }
}

TEST(FairMoves, ABallGrowsAsMuchAlongTheGridAsAcrossIt) {
  const Volume<float> volume = volume_of([](const glm::dvec3& p) { return blurred_ball(13.0, kBlur, glm::length(p)); });
  VolumeSource source(volume);
  SilentProgress progress;
  const QuadMesh mesh = mesh_of(source);
  const std::vector<glm::vec3> moves =
      fair_moves(mesh, {.growth = static_cast<float>(kBlur * kBlur)}, progress).value();
  std::array<double, 2> sum{}, count{};
  for (std::size_t v = 0; v < moves.size(); ++v) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(mesh.positions[v]) - kMiddle);
    const double along = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}),
                 across = (std::abs(n.x) + std::abs(n.y) + std::abs(n.z)) / std::numbers::sqrt3;
    if (along < 0.95 && across < 0.97) continue;
    const std::size_t which = along >= 0.95 ? 0 : 1;
    sum[which] += glm::dot(glm::dvec3(moves[v]), n);
    count[which] += 1.0;
  }
  for (const double mean : {sum[0] / count[0], sum[1] / count[1]})
    EXPECT_NEAR(mean, kBlur * kBlur / 13.0, 0.12 * kBlur * kBlur / 13.0);  // steps of one length would be off by .4
}

TEST(FairMoves, ARidgeComesNearerToItsEdge) {
  // A quarter space, blurred: its edge along z stands at the middle. Half of the product is reached .77 of the blur
  // from it, where the curvature is largest; what s^2 H gives there is more than it is away from the edge.
  const Volume<float> volume = volume_of([&](const glm::dvec3& p) {
    const auto side = [](double d) { return 0.5 * std::erfc(d / (kBlur * std::numbers::sqrt2)); };
    return side(p.x) * side(p.y);
  });
  const auto tip = [](const QuadMesh& mesh) {
    double nearest = 1e9;
    for (const glm::vec3& at : mesh.positions) {
      const glm::dvec3 p = glm::dvec3(at) - kMiddle;
      if (std::abs(p.z) < 10.0) nearest = std::min(nearest, std::hypot(p.x, p.y));
    }
    return nearest;
  };
  VolumeSource source(volume);
  const double before = tip(mesh_of(source)), after = tip(faired(volume, static_cast<float>(kBlur * kBlur)));
  EXPECT_NEAR(before, 0.77 * kBlur, 0.25);  // vertices lie further inside
  EXPECT_LT(after, before - 0.1);
}

// Noise of .08 of the contrast, that hangs together over two voxels: filters leave 22 dB. Four draws had .937 to .954.
TEST(FairMoves, NoiseOfASurfaceGetsLessThoughItIsSharpened) {
  for (const std::uint32_t seed : {95U, 96U}) {
    const std::vector<double> grain = noise(seed);
    std::size_t i = 0;
    const Volume<float> volume =
        volume_of([&](const glm::dvec3& p) { return blurred_ball(13.0, kBlur, glm::length(p)) + 0.08 * grain[i++]; });
    VolumeSource source(volume);
    const double before = radii(mesh_of(source)).spread,
                 after = radii(faired(volume, static_cast<float>(kBlur * kBlur))).spread;
    EXPECT_GT(before, 0.1);
    EXPECT_LT(after, 0.98 * before);
  }
}

// Crossings between two points of an edge of .6 voxel lie up to .02 from it, before and after.
TEST(FairMoves, ABlurredPlaneOfAnyTiltGoesAsFarAsMovesSay) {
  for (const double blur : {0.6, 0.9})
    for (const glm::dvec3& way : {glm::dvec3(1, 0, 0), glm::dvec3(3, 1, 0), glm::dvec3(2, 2, 1), glm::dvec3(1, 1, 1)})
      for (const double move : {-0.3, -0.1, 0.3}) {
        const glm::dvec3 normal = glm::normalize(way);
        const Volume<float> volume = volume_of(
            [&](const glm::dvec3& p) { return 0.5 * std::erfc(glm::dot(p, normal) / (blur * std::numbers::sqrt2)); });
        const auto mean = [&](const QuadMesh& mesh) {
          double sum = 0.0, count = 0.0;
          for (const glm::vec3& at : mesh.positions) {
            const glm::dvec3 p = glm::dvec3(at) - kMiddle;
            if (glm::length(p) > 12.0) continue;  // the border's caps
            sum += glm::dot(p, normal);
            count += 1.0;
          }
          return sum / count;
        };
        VolumeSource source(volume);
        const QuadMesh mesh = mesh_of(source);
        const std::vector<glm::vec3> moves(mesh.positions.size(), glm::vec3(move * normal));
        CarriedSource carried(source, mesh.positions, moves, 1.0f);
        EXPECT_NEAR(mean(mesh_of(carried)) - mean(mesh), move, 0.02) << blur << " " << way.y << " " << move;
      }
}

/// Places of a mesh, sorted, each coordinate by the axis that `axes` names.
std::vector<std::array<float, 3>> places(const QuadMesh& mesh, const std::array<int, 3>& axes) {
  std::vector<std::array<float, 3>> all;
  for (const glm::vec3& p : mesh.positions) all.push_back({p[axes[0]], p[axes[1]], p[axes[2]]});
  std::ranges::sort(all);
  return all;
}

TEST(FairMoves, AxesMayBeExchangedToTheBit) {
  const std::vector<double> grain = noise(97);
  std::size_t i = 0;
  const Volume<float> volume =
      volume_of([&](const glm::dvec3& p) { return blurred_ball(13.0, kBlur, glm::length(p)) + 0.05 * grain[i++]; });
  const QuadMesh plain = faired(volume, 0.8f);
  for (const std::array<int, 3> axes : {std::array{1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {2, 1, 0}, {0, 2, 1}}) {
    Volume<float> turned(volume.dims);
    std::array<int, 3> at{};  // in the turned one; its axis k is axes[k] of the volume
    for (at[2] = 0; at[2] < kSize; ++at[2])
      for (at[1] = 0; at[1] < kSize; ++at[1])
        for (at[0] = 0; at[0] < kSize; ++at[0]) {
          std::array<int, 3> from{};
          for (std::size_t k = 0; k < 3; ++k) from[static_cast<std::size_t>(axes[k])] = at[k];
          turned.row(at[1], at[2])[at[0]] = volume.at(from[0], from[1], from[2]);
        }
    EXPECT_EQ(places(faired(turned, 0.8f), {0, 1, 2}), places(plain, axes)) << axes[0] << axes[1] << axes[2];
  }
}

TEST(FairMoves, AreTheSameForAnyNumberOfThreads) {
  const Volume<float> volume =
      volume_of([&](const glm::dvec3& p) { return blurred_ball(13.0, kBlur, glm::length(p)); });
  VolumeSource source(volume);
  SilentProgress progress;
  const QuadMesh mesh = mesh_of(source);
  const std::vector<glm::vec3> many = fair_moves(mesh, {.growth = 0.5f}, progress).value();
  set_thread_count(1);
  const std::vector<glm::vec3> single = fair_moves(mesh, {.growth = 0.5f}, progress).value();
  set_thread_count(0);
  EXPECT_EQ(std::memcmp(many.data(), single.data(), many.size() * sizeof many[0]), 0);
}

}  // namespace
}  // namespace dubsar
