// The surface where the volume ends: closed boxes of known size, open discs, and volumes too small for anything else.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tests/core/extract/extract_help.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

Volume<float> constant(Dims dims, float value) {
  Volume<float> volume(dims);
  std::fill_n(volume.voxels.data(), dims.count(), value);
  return volume;
}

TEST(ExtractBoundary, FullVolumeIsClosedByAnExactBox) {
  for (const Dims dims : {Dims{2, 2, 2}, Dims{5, 7, 3}, Dims{64, 3, 2}, Dims{65, 2, 4}}) {
    const Volume<float> volume = constant(dims, 1.0f);
    const QuadMesh mesh = build(sample(volume, 0.5f));
    EXPECT_TRUE(check(mesh).watertight());
    EXPECT_EQ(check(mesh).euler, 2);
    double area = 0.0, enclosed = 0.0;
    const Triangulation cut = triangulate(mesh, {});
    for (const Triangle& t : cut.triangles) {
      const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
      area += 0.5 * glm::length(glm::cross(b - a, c - a));
      enclosed += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    const double x = static_cast<double>(dims.x - 1), y = static_cast<double>(dims.y - 1),
                 z = static_cast<double>(dims.z - 1);
    EXPECT_NEAR(enclosed, x * y * z, 1e-9);
    EXPECT_NEAR(area, 2 * (x * y + y * z + z * x), 1e-9);
    EXPECT_TRUE(build(sample(volume, 0.5f, false)).quads.empty());
    EXPECT_TRUE(build(sample(volume, 0.5f, false)).positions.empty());
    EXPECT_TRUE(build(sample(volume, 1.5f)).quads.empty());
  }
}

TEST(ExtractBoundary, OpenHalfSpaceIsADisc) {
  Volume<float> volume({20, 9, 12});
  for (std::int64_t i = 0; i < volume.dims.count(); ++i) volume.voxels[i] = static_cast<float>(i % 20) - 7.25f;
  const QuadMesh open = build(sample(volume, 0.0f, false, 16));
  EXPECT_EQ(open.quad_count(), 7 * 10);
  EXPECT_EQ(open.vertex_count(), 8 * 11);
  const MeshCheck found = check(open);
  EXPECT_TRUE(found.manifold());
  EXPECT_EQ(found.boundary_edges, 2 * (7 + 10));
  EXPECT_EQ(found.euler, 1);
  for (const glm::vec3& p : open.positions) EXPECT_NEAR(p.x, 7.25f, 1e-4f);
  const MeshCheck closed = check(build(sample(volume, 0.0f, true)));
  EXPECT_TRUE(closed.watertight());
  EXPECT_EQ(closed.euler, 2);
}

TEST(ExtractBoundary, TinyVolumesAreManifoldOpenAndClosed) {
  set_thread_count(1);
  std::int64_t split = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    const Dims dims{1 + seed % 4, 1 + seed / 4 % 4, 1 + seed / 16 % 5};
    const Volume<float> volume = random_volume(dims, seed, static_cast<int>(seed % 5));
    const MeshCheck closed = check(build(sample(volume, 0.0f, true)));
    EXPECT_TRUE(closed.triangles == 0 || closed.watertight()) << "seed " << seed;
    const QuadMesh open = build(sample(volume, 0.0f, false));
    const MeshCheck found = check(open);
    EXPECT_TRUE(found.manifold()) << "seed " << seed;
    EXPECT_EQ(found.vertices - open.vertex_count(), static_cast<std::int64_t>(triangulate(open, {}).steiner.size()));
    for (std::size_t v = 1; v < open.positions.size(); ++v) split += open.positions[v] == open.positions[v - 1];
  }
  set_thread_count(0);
  EXPECT_GT(split, 10) << "no vertex had to be doubled: the test does not reach bow-ties";
}

}  // namespace
}  // namespace dubsar
