#include "core/relief/smoothing/scatter_blocks.h"

#include <gtest/gtest.h>

#include <set>

#include "core/extract/extract.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

TEST(ScatterBlocks, HoldTheGroupsThatTouchThemAndNoOthers) {
  const Volume<float> volume = random_volume({62, 58, 55}, 11, 0);
  VolumeSource source(volume);
  SilentProgress progress;
  const QuadMesh mesh = build_quad_mesh(*sample_surface(source, {.isovalue = 0.0f}, progress), progress).value();
  ASSERT_GT(mesh.vertex_count(), 2 * kScatterBlock);
  std::vector<std::set<std::uint32_t>> around_vertices(
      static_cast<std::size_t>((mesh.vertex_count() - 1) / kScatterBlock + 1)),
      around_quads(static_cast<std::size_t>((mesh.quad_count() - 1) / kScatterBlock + 1));
  for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
    const Polygon polygon = mesh.polygon(q);
    for (int i = 0; i < polygon.size; ++i) {
      const std::uint32_t v = polygon.vertex[static_cast<std::size_t>(i)];
      around_vertices[static_cast<std::size_t>(v / kScatterBlock)].insert(q / kQuadGroup);
      around_quads[static_cast<std::size_t>(q / kScatterBlock)].insert(v / kVertexGroup);
    }
  }
  const auto same = [](const ScatterBlocks& found, const std::vector<std::set<std::uint32_t>>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t b = 0; b < found.size(); ++b)
      EXPECT_EQ(found[b], std::vector<std::uint32_t>(expected[b].begin(), expected[b].end())) << b;
  };
  same(quad_groups_of_vertices(mesh), around_vertices);
  same(vertex_groups_of_quads(mesh, kScatterBlock), around_quads);
}

TEST(ScatterMemory, IsHandedOn) {
  ScatterMemory memory(10);
  auto first = memory.take();
  ASSERT_EQ(first->size(), 10u);
  const float* where = first->data();
  memory.give_back(std::move(first));
  EXPECT_EQ(memory.take()->data(), where);
}

}  // namespace
}  // namespace dubsar
