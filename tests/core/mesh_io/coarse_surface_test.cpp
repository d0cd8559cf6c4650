// What large mesh files look like before they are read: the same shape, closed, in the file's numbers.

#include "core/mesh_io/coarse_surface.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "core/mesh/mesh_check.h"

namespace dubsar {
namespace {

constexpr double kRadius = 30.0;
constexpr int kRound = 600, kUp = 400;  // 480 000 triangles

glm::vec3 place(int u, int v) {
  const double a = 2 * std::numbers::pi * (u % kRound) / kRound,
               b = std::numbers::pi * (static_cast<double>(v) / kUp - 0.5);
  return {kRadius * std::cos(a) * std::cos(b) + 100, kRadius * std::sin(a) * std::cos(b) - 7, kRadius * std::sin(b)};
}

template <class Triangle>
void each_triangle(const Triangle& triangle) {
  for (int v = 0; v < kUp; ++v)
    for (int u = 0; u < kRound; ++u) {
      triangle(std::array{std::array{u, v}, std::array{u + 1, v}, std::array{u + 1, v + 1}});
      triangle(std::array{std::array{u, v}, std::array{u + 1, v + 1}, std::array{u, v + 1}});
    }
}

std::string sphere_stl() {
  std::string out(84, ' ');
  std::uint32_t count = 0;
  each_triangle([&](const auto& corners) {
    float facet[12]{};
    for (std::size_t c = 0; c < 3; ++c)
      for (int axis = 0; axis < 3; ++axis)
        facet[3 + 3 * c + static_cast<std::size_t>(axis)] = place(corners[c][0], corners[c][1])[axis];
    out.append(reinterpret_cast<const char*>(facet), sizeof facet).append(2, '\0');
    ++count;
  });
  std::memcpy(out.data() + 80, &count, 4);
  return out;
}

std::string sphere_obj(bool from_the_end) {
  std::string out = "# a sphere\n";
  for (int v = 0; v <= kUp; ++v)
    for (int u = 0; u < kRound; ++u) {
      const glm::vec3 p = place(u, v);
      out += fmt::format("v {:.6f} {:.6f} {:.6f} 0.5 0.5 0.5\nvn 0 0 1\n", p.x, p.y, p.z);
    }
  const int all = (kUp + 1) * kRound;
  each_triangle([&](const auto& corners) {
    out += "f";
    for (const auto& [u, v] : corners) {
      const int id = v * kRound + u % kRound + 1 - (from_the_end ? all + 1 : 0);
      out += fmt::format(" {0}//{0}", id);
    }
    out += "\n";
  });
  return out;
}

void expect_sphere(const std::optional<TriMesh>& found) {
  ASSERT_TRUE(found);
  EXPECT_GT(found->positions.size(), 20'000u);
  EXPECT_LT(found->positions.size(), 90'000u);
  constexpr double kCell = 2 * kRadius / 160;
  double volume = 0.0;
  for (const glm::vec3& p : found->positions)
    EXPECT_NEAR(glm::distance(glm::dvec3(p), glm::dvec3(100, -7, 0)), kRadius, kCell);
  for (const Triangle& t : found->triangles) {
    const glm::dvec3 a(found->positions[t[0]]), b(found->positions[t[1]]), c(found->positions[t[2]]);
    volume += glm::dot(a - glm::dvec3(100, -7, 0), glm::cross(b - a, c - a)) / 6;
  }
  EXPECT_NEAR(volume, 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius, 0.01 * 113097)
      << "turned outwards, no holes";
  EXPECT_EQ(check_mesh(found->positions, found->triangles).boundary_edges, 0);
}

TEST(CoarseSurface, OfABinaryStlIsTheSameShapeWithoutHoles) {
  const std::string bytes = sphere_stl();
  ASSERT_GE(bytes.size(), kCoarseFrom);
  expect_sphere(coarse_surface(MeshFormat::kStl, bytes));
}

TEST(CoarseSurface, OfAnObjIsTheSameShapeWhicheverWayFacesCount) {
  for (const bool from_the_end : {false, true}) {
    const std::string bytes = sphere_obj(from_the_end);
    ASSERT_GE(bytes.size(), kCoarseFrom);
    expect_sphere(coarse_surface(MeshFormat::kObj, bytes));
  }
}

TEST(CoarseSurface, WhatIsSmallDamagedOrQuickHasNone) {
  std::string stl = sphere_stl(), obj = sphere_obj(false);
  EXPECT_FALSE(coarse_surface(MeshFormat::kPly, stl));
  EXPECT_FALSE(coarse_surface(MeshFormat::kStl, std::string_view(stl).substr(0, stl.size() - 7)));
  EXPECT_FALSE(coarse_surface(MeshFormat::kStl, std::string_view(stl).substr(0, 5000)));
  EXPECT_FALSE(coarse_surface(MeshFormat::kObj, obj + "f 1 2 99999999\n"));
  EXPECT_FALSE(coarse_surface(MeshFormat::kObj, obj + "v 1 nan 2\n"));
  EXPECT_FALSE(coarse_surface(MeshFormat::kObj, obj + "v 1e6 0 0\n")) << "outside of the box so far";
  const float nan = NAN;
  std::memcpy(stl.data() + 84 + 12, &nan, 4);
  EXPECT_FALSE(coarse_surface(MeshFormat::kStl, stl));
}

}  // namespace
}  // namespace dubsar
