#include "core/contact/film_refine.h"

#include <gtest/gtest.h>

#include "tests/core/contact/interface_scene.h"

namespace dubsar {
namespace {

constexpr int kFilmEdge = 17;

/// A sheet that lies 1.2 steps over the film in its middle and on it at its ends.
InterfaceMesh lifted_sheet(const FilmScene& scene) {
  return sheet(kFilmEdge, [&](int x, int y) {
    const float u = static_cast<float>(x - kFilmEdge / 2), v = static_cast<float>(y - kFilmEdge / 2);
    return scene.at(u, v, 1.2f - 0.02f * std::abs(u * v));
  });
}

Following all_follow(const InterfaceMesh& mesh, float share) {
  return {std::vector<float>(mesh.added.size(), share), std::vector<bool>(mesh.added.size(), false)};
}

TEST(FollowDips, AFilmAlongATiltedPlaneIsFoundToAFractionOfAStep) {
  const FilmScene scene;
  InterfaceMesh mesh = lifted_sheet(scene);
  const InterfaceRings rings(mesh, 0);
  follow_dips(mesh, rings, {}, all_follow(mesh, 1.0f), scene.density(), {.most = 2.5f});
  // Trilinear samples are wrong by f''/8 at most (along axis i the second derivative is that across the film times
  // n_i^2, and these add up to 1). The vertex of the parabola through three samples h = .5 apart is off by
  // h/2 * (f''/8) / (f'' h^2) = 1 / (16 h) then, before anything is averaged.
  constexpr float kMostOff = 0.125f;
  float sum = 0.0f;
  for (int y = 1; y + 1 < kFilmEdge; ++y)
    for (int x = 1; x + 1 < kFilmEdge; ++x) {
      const float off = scene.distance(mesh.added[static_cast<std::size_t>(y * kFilmEdge + x)]);
      EXPECT_LE(std::abs(off), kMostOff) << x << " " << y;
      sum += off * off;
    }
  EXPECT_LE(std::sqrt(sum / ((kFilmEdge - 2) * (kFilmEdge - 2))), 0.5f * kMostOff);
}

TEST(FollowDips, WhatIsNotToFollowStaysToTheBit) {
  const FilmScene scene;
  InterfaceMesh mesh = lifted_sheet(scene);
  const std::vector<glm::vec3> before = mesh.added;
  Following follows = all_follow(mesh, 0.0f);
  for (std::size_t i = 0; i < follows.share.size() / 2; ++i) follows.share[i] = 1.0f;
  follow_dips(mesh, InterfaceRings(mesh, 0), {}, follows, scene.density(), {.most = 2.5f});
  int moved = 0;
  for (std::size_t i = 0; i < follows.share.size(); ++i) {
    if (follows.share[i] == 0.0f)
      EXPECT_EQ(mesh.added[i], before[i]);
    else
      moved += mesh.added[i] != before[i];
  }
  EXPECT_GT(moved, 50);
}

/// How far a sheet on the film is from it after it was followed, root of the mean square without its rim.
float error_after(const FilmScene& scene) {
  InterfaceMesh mesh = sheet(kFilmEdge, [&](int x, int y) {
    return scene.at(static_cast<float>(x - kFilmEdge / 2), static_cast<float>(y - kFilmEdge / 2), 0.0f);
  });
  follow_dips(mesh, InterfaceRings(mesh, 0), {}, all_follow(mesh, 1.0f), scene.density(), {.most = 2.5f});
  float sum = 0.0f;
  for (int y = 1; y + 1 < kFilmEdge; ++y)
    for (int x = 1; x + 1 < kFilmEdge; ++x) {
      const float off = scene.distance(mesh.added[static_cast<std::size_t>(y * kFilmEdge + x)]);
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

}  // namespace
}  // namespace dubsar
