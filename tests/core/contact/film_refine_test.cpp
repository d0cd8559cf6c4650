#include "core/contact/film_refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "tests/core/contact/interface_scene.h"

namespace dubsar {
namespace {

constexpr int kFilmEdge = 17, kFilmMiddle = kFilmEdge / 2;

/// A sheet that lies 1.2 steps over the film in its middle and on it at its ends.
InterfaceMesh lifted_sheet(const FilmScene& scene) {
  return sheet(kFilmEdge, [&](int x, int y) {
    const float u = static_cast<float>(x - kFilmMiddle), v = static_cast<float>(y - kFilmMiddle);
    return scene.at(u, v, 1.2f - 0.02f * std::abs(u * v));
  });
}

Following all_follow(const InterfaceMesh& mesh, bool moves) {
  return {std::vector<bool>(mesh.added.size(), moves), std::vector<bool>(mesh.added.size(), false)};
}

TEST(FollowDips, AFilmAlongATiltedPlaneIsFoundToAFractionOfAStep) {
  const FilmScene scene;
  InterfaceMesh mesh = lifted_sheet(scene);
  const InterfaceRings rings(mesh, 0);
  follow_dips(mesh, rings, {}, all_follow(mesh, true), scene.density(), {.most = 2.5f});
  // Trilinear samples are wrong by f''/8 at most (along axis i the second derivative is that across the film times
  // n_i^2, and these add up to 1). The vertex of the parabola through three samples h = .5 apart is off by
  // h/2 * (f''/8) / (f'' h^2) = 1 / (16 h) then, before anything is averaged.
  constexpr float kMostOff = 0.125f;
  float sum = 0.0f;
  for (int y = 1; y + 1 < kFilmEdge; ++y)
    for (int x = 1; x + 1 < kFilmEdge; ++x) {
      const float off =
          scene.distance(mesh.added[static_cast<std::size_t>(y) * kFilmEdge + static_cast<std::size_t>(x)]);
      EXPECT_LE(std::abs(off), kMostOff) << x << " " << y;
      sum += off * off;
    }
  EXPECT_LE(std::sqrt(sum / ((kFilmEdge - 2) * (kFilmEdge - 2))), 0.5f * kMostOff);
}

TEST(FollowDips, WhatIsNotToFollowStaysToTheBit) {
  const FilmScene scene;
  InterfaceMesh mesh = lifted_sheet(scene);
  const std::vector<glm::vec3> before = mesh.added;
  Following follows = all_follow(mesh, false);
  for (std::size_t i = 0; i < follows.moves.size() / 2; ++i) follows.moves[i] = true;
  follow_dips(mesh, InterfaceRings(mesh, 0), {}, follows, scene.density(), {.most = 2.5f});
  int moved = 0;
  for (std::size_t i = 0; i < follows.moves.size(); ++i) {
    if (!follows.moves[i])
      EXPECT_EQ(mesh.added[i], before[i]);
    else
      moved += mesh.added[i] != before[i];
  }
  EXPECT_GT(moved, 50);
}

/// How far a sheet on the film is from it after it was followed, root of the mean square without its rim.
float error_after(const FilmScene& scene) {
  InterfaceMesh mesh = sheet(kFilmEdge, [&](int x, int y) {
    return scene.at(static_cast<float>(x - kFilmMiddle), static_cast<float>(y - kFilmMiddle), 0.0f);
  });
  follow_dips(mesh, InterfaceRings(mesh, 0), {}, all_follow(mesh, true), scene.density(), {.most = 2.5f});
  float sum = 0.0f;
  for (int y = 1; y + 1 < kFilmEdge; ++y)
    for (int x = 1; x + 1 < kFilmEdge; ++x) {
      const float off =
          scene.distance(mesh.added[static_cast<std::size_t>(y) * kFilmEdge + static_cast<std::size_t>(x)]);
      sum += off * off;
    }
  return std::sqrt(sum / ((kFilmEdge - 2) * (kFilmEdge - 2)));
}

TEST(FollowDips, ChanceIsNotFollowed) {
  FilmScene scene;
  scene.noise = 0.4f;
  scene.depth = 0.0f;
  EXPECT_LT(error_after(scene), 0.75f) << "nothing there: the sheet was right";
  scene.depth = 0.25f;
  EXPECT_LT(error_after(scene), 0.55f) << "a faint film";
}

/// A cone 7 steps deep and 11 wide in a plane, as a film of air, blurred.
struct DentScene {
  static constexpr int kEdge = 40;
  static constexpr float kTop = 26.0f, kDepth = 7.0f, kRadius = 5.5f, kBlur = 0.65f;

  static float height(float x, float y) {
    const float r = std::hypot(x - 20.1f, y - 19.8f);
    return kTop - kDepth * std::max(0.0f, 1.0f - r / kRadius);
  }

  /// Sum over small pieces of the film of what the blur makes of them.
  static BandDensity density() {
    const Dims dims{kEdge, kEdge, kEdge};
    Volume<float> scan(dims);
    BitVolume inside(dims);
    for (std::int64_t k = 0; k < dims.count(); ++k) {
      const std::int64_t x = k % kEdge, y = k / kEdge % kEdge, z = k / dims.slice();
      scan.at(x, y, z) = 1.0f;
      inside.set(x, y, z, true);
    }
    constexpr float kPiece = 0.25f, kFilm = 0.3f;
    constexpr int kFar = 3;
    const float slope = kDepth / kRadius, of_piece = kFilm * kPiece * kPiece;
    for (float y = 1.0f; y < kEdge - 1.0f; y += kPiece)
      for (float x = 1.0f; x < kEdge - 1.0f; x += kPiece) {
        const glm::vec3 q(x, y, height(x, y));
        const float air = q.z < kTop ? of_piece * std::sqrt(1.0f + slope * slope) : of_piece;
        const glm::ivec3 middle(glm::round(q));
        for (int i = 0; i < 7 * 7 * 7; ++i) {
          const glm::ivec3 p = middle + glm::ivec3(i % 7, i / 7 % 7, i / 49) - kFar;
          if (std::min({p.x, p.y, p.z}) < 0 || std::max({p.x, p.y, p.z}) >= kEdge) continue;
          const glm::vec3 off = glm::vec3(p) - q;
          scan.at(p.x, p.y, p.z) -=
              air * std::exp(-0.5f * glm::dot(off, off) / (kBlur * kBlur)) / std::pow(2.5066283f * kBlur, 3.0f);
        }
      }
    std::vector<PatchPoint> samples;
    for (int y = 4; y < kEdge - 4; ++y)
      for (int x = 4; x < kEdge - 4; ++x) samples.push_back({{x, y, kTop}, {0.0f, 0.0f, 1.0f}});
    SilentProgress progress;
    const ContactBand band = ContactBand::make(inside, std::move(samples), 12.0f, progress).value();
    VolumeSource source(scan);
    return BandDensity::read(band, source, progress).value();
  }
};

TEST(FollowDips, TheTipOfADentIsFollowedDown) {
  constexpr int kSide = 30;
  // As a cut leaves it: the mean over a disk of some two steps.
  InterfaceMesh mesh = sheet(kSide, [](int x, int y) {
    const glm::vec2 p(x + 5, y + 5);
    float sum = 0.0f;
    for (int v = -2; v <= 2; ++v)
      for (int u = -2; u <= 2; ++u)
        sum += DentScene::height(p.x + 0.8f * static_cast<float>(u), p.y + 0.8f * static_cast<float>(v));
    return glm::vec3(p, sum / 25.0f);
  });
  const auto lowest = [&] {
    return std::min_element(mesh.added.begin(), mesh.added.end(), [](auto& a, auto& b) { return a.z < b.z; })->z;
  };
  const float before = DentScene::kTop - lowest();
  follow_dips(mesh, InterfaceRings(mesh, 0), {}, all_follow(mesh, true), DentScene::density(),
              {.blur_variance = DentScene::kBlur * DentScene::kBlur});
  EXPECT_LT(before, 0.8f * DentScene::kDepth);
  EXPECT_GT(DentScene::kTop - lowest(), 0.82f * DentScene::kDepth) << before << " before";
  EXPECT_LT(DentScene::kTop - lowest(), 1.1f * DentScene::kDepth);
}

}  // namespace
}  // namespace dubsar
