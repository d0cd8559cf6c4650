#include "display/render/mesh/lod.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "display/optics/off_axis.h"
#include "display/render/multi_view.h"
#include "display/render/passes/mesh_pass.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

glm::dvec3 position_mm(const PackedMesh& mesh, std::uint32_t v) {
  const auto& p = mesh.vertices[v].position;
  return mesh.box_mm.min + glm::dvec3(p[0], p[1], p[2]) / 65535.0 * mesh.box_mm.size();
}

TEST(Lod, ASphereStaysASphereToWithinACell) {
  const PackedMesh fine = pack_mesh(testing::sphere(10, 200, 400)).value();
  for (const double cell : {0.3, 1.0, 3.0}) {
    const PackedMesh coarse = cluster_vertices(fine, cell);
    double area = 0;
    for (const Triangle& t : coarse.triangles) {
      const glm::dvec3 a = position_mm(coarse, t[0]), b = position_mm(coarse, t[1]), c = position_mm(coarse, t[2]);
      area += glm::length(glm::cross(b - a, c - a)) / 2;
      for (const std::uint32_t v : t) {
        EXPECT_NEAR(glm::length(position_mm(coarse, v)), 10, cell);
        const glm::dvec3 normal = decode_octahedral(coarse.vertices[v].normal);
        EXPECT_GT(glm::dot(normal, glm::normalize(position_mm(coarse, v))), 0.9);
      }
    }
    EXPECT_NEAR(area, 400 * std::numbers::pi, 400 * std::numbers::pi * (cell / 10 + 0.02)) << "cell " << cell;
    EXPECT_LT(coarse.triangles.size(), 4.5 * 400 * std::numbers::pi / (cell * cell)) << "cell " << cell;
    EXPECT_EQ(coarse.box_mm.max, fine.box_mm.max);
  }
}

TEST(Lod, ClosedSurfacesStayClosed) {
  const PackedMesh coarse = cluster_vertices(pack_mesh(testing::sphere(10, 100, 200)).value(), 1.0);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;  // each edge as often one way as the other
  for (const Triangle& t : coarse.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  const auto open = std::count_if(balance.begin(), balance.end(), [](const auto& edge) { return edge.second != 0; });
  EXPECT_LE(open, static_cast<long>(balance.size() / 200)) << "at most where repeated triangles were joined";
}

TEST(Lod, ThinWallsAndPartitionsKeepBothSides) {
  TriMesh mesh;  // two sheets 0.1 mm apart, back to back, in two partitions each
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const glm::vec3 corner(i, j, 0);
      testing::add_rectangle(mesh, corner + glm::vec3(0, 0, 0.1f), {1, 0, 0}, {0, 1, 0},
                             static_cast<std::uint8_t>(i / 10));
      testing::add_rectangle(mesh, corner, {0, 1, 0}, {1, 0, 0}, static_cast<std::uint8_t>(i / 10));
    }
  const PackedMesh coarse = cluster_vertices(pack_mesh(mesh).value(), 5.0);
  EXPECT_LT(coarse.triangles.size(), 200u);
  for (std::uint8_t p = 0; p < 2; ++p) {
    int up = 0, down = 0;
    for (auto t = coarse.first_triangle[p]; t < coarse.first_triangle[p + 1]; ++t)
      for (const std::uint32_t v : coarse.triangles[static_cast<std::size_t>(t)]) {
        EXPECT_EQ(coarse.vertices[v].attributes >> 13, p);
        (decode_octahedral(coarse.vertices[v].normal).z > 0.9 ? up : down)++;
      }
    EXPECT_GT(up, 0);
    EXPECT_EQ(up, down);
  }
}

TEST(Lod, ChunksHoldEveryTriangleOnceInsideTheirBoxes) {
  PackedMesh mesh = pack_mesh(testing::lettered_box()).value();
  auto before = mesh.triangles;
  sort_into_chunks(mesh);
  auto after = mesh.triangles;
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  EXPECT_EQ(after, before);
  std::int64_t next = 0;
  for (const TriangleChunk& chunk : mesh.chunks) {
    EXPECT_EQ(chunk.first, next);
    next += chunk.count;
    for (auto t = chunk.first; t < chunk.first + chunk.count; ++t)
      for (const std::uint32_t v : mesh.triangles[static_cast<std::size_t>(t)]) {
        EXPECT_EQ(mesh.vertices[v].attributes >> 13, chunk.partition);
        const glm::dvec3 p = position_mm(mesh, v);
        for (int a = 0; a < 3; ++a) {
          EXPECT_GE(p[a], chunk.box_mm.min[a] - 1e-9);
          EXPECT_LE(p[a], chunk.box_mm.max[a] + 1e-9);
        }
      }
  }
  EXPECT_EQ(next, static_cast<std::int64_t>(mesh.triangles.size()));
}

TEST(Lod, OctahedralNormalsComeBack) {
  for (int i = 0; i < 1000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 1000, phi = 2.4 * i, r = std::sqrt(1 - z * z);
    const glm::dvec3 n(r * std::cos(phi), r * std::sin(phi), z);
    EXPECT_GT(glm::dot(decode_octahedral(encode_octahedral(n)), n), 1 - 1e-7) << i;
  }
}

TEST(MultiView, KeyViewsGoEvenlyFromTheFirstToTheLast) {
  for (const int count : {2, 5, 12, 45, 48, 66, 100}) {
    const auto keys = key_views(count, 12);
    EXPECT_EQ(keys.size(), static_cast<std::size_t>(std::min(count, 12)));
    EXPECT_EQ(keys.front(), 0);
    EXPECT_EQ(keys.back(), count - 1);
    for (std::size_t i = 1; i < keys.size(); ++i)
      EXPECT_NEAR(keys[i] - keys[i - 1], (count - 1.0) / (static_cast<double>(keys.size()) - 1), 1.0);
  }
  EXPECT_EQ(key_views(4, 0), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(key_views(1, 12), std::vector<int>{0});
  EXPECT_EQ(key_views(9, 1), std::vector<int>{4});
}

TEST(MultiView, PixelsHaveTheSizeThatTheWindowGivesThem) {
  const Screen screen{
      .width_mm = 200, .height_mm = 100, .width_px = 400, .height_px = 200, .window_w = 400, .window_h = 200};
  View view = viewer_view(screen.window_rect(), Observer(), {80, 30, 500});
  EXPECT_NEAR(mm_per_pixel_at(view, {0, 0, 0}, 400), 0.5, 1e-9) << "in the panel's plane";
  EXPECT_NEAR(mm_per_pixel_at(view, {0, 0, -500}, 400), 1.0, 1e-9) << "twice as far away";
  glm::dmat4 magnified(1.0);
  for (int a = 0; a < 3; ++a) magnified[a][a] = 4.0;
  view.view_from_world = view.view_from_world * magnified;
  EXPECT_NEAR(mm_per_pixel_at(view, {0, 0, 0}, 400), 0.125, 1e-9) << "of an object shown at four times its size";
}

}  // namespace
}  // namespace dubsar
