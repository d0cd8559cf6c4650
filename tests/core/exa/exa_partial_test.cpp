// Parts of a file: a coarser level is a closed surface of every second, fourth or eighth point; a box is the surface of
// its bricks, where the whole has it, and a file of its own when it is written.

#include <algorithm>
#include <cstdio>

#include "core/mesh/mesh_check.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {

/// Vertices where the samples put them, no attributes.
SurfaceModel bare_model_of(const Dims& dims, unsigned seed) {
  SurfaceModel model = sample_model(dims, Kind::kBlob, seed);
  SilentProgress progress;
  model.mesh = build_quad_mesh(model.samples, progress).value();
  model.attributes = {};
  model.quad_partition.clear();
  model.partitions.clear();
  model.frame = {};
  model.frame.input_voxel = {{.1, .1, .1}, ""};
  return model;
}
MeshCheck checked(const SurfaceModel& model) {
  const TriMesh mesh = make_tri_mesh(model).value();
  return check_mesh(mesh.positions, mesh.triangles);
}

TEST_F(ExaFile, LevelsAreClosedSurfacesOfEverySecondFourthAndEighthPoint) {
  const SurfaceModel model = bare_model_of({150, 41, 37}, 3);
  ASSERT_TRUE(write_exa(folder_ / "a.exa", model, progress_));
  for (int level = 1; level <= 3; ++level) {
    const auto coarse = read_exa_level(folder_ / "a.exa", level, progress_);
    ASSERT_TRUE(coarse) << coarse.error().message;
    ASSERT_GT(coarse->mesh.vertex_count(), 0);
    EXPECT_LT(coarse->mesh.vertex_count(), model.mesh.vertex_count() >> level);
    EXPECT_EQ(coarse->frame.scale.x, std::exp2(level));
    EXPECT_TRUE(checked(*coarse).watertight()) << level;
    const Dims& d = coarse->samples.dims;
    for (std::int64_t z = 0; z < d.z; ++z)
      for (std::int64_t y = 0; y < d.y; ++y)
        for (std::int64_t x = 0; x < d.x; ++x)
          ASSERT_EQ(coarse->samples.signs.get(x, y, z), model.samples.signs.get(x << level, y << level, z << level));
  }
}

TEST_F(ExaFile, ABoxIsTheSurfaceOfItsBricksAndAFileOfItsOwn) {
  const SurfaceModel model = bare_model_of({290, 34, 30}, 4);
  const auto path = folder_ / "a.exa", cut = folder_ / "cut.exa";
  ASSERT_TRUE(write_exa(path, model, progress_));
  // In the middle brick, away from its sides; vertices stand in the order of their cells here and there.
  const auto well_inside = [](const QuadMesh& mesh, float low) {
    std::vector<glm::vec3> places;
    for (const glm::vec3& p : mesh.positions) {
      const glm::vec3 own(p.x - low, p.y, p.z);
      if (own.x > 1.013f && own.x < 126.987f && own.y > 1.013f && own.y < 31.987f && own.z > 1.013f && own.z < 27.987f)
        places.push_back(own);
    }
    return places;
  };
  const auto box = read_exa_box(path, {{140, 3, 3}, {150, 9, 9}}, progress_);
  ASSERT_TRUE(box) << box.error().message;
  EXPECT_EQ(box->samples.dims, (Dims{129, 34, 30})) << "the middle brick with both sides";
  EXPECT_EQ(box->frame.origin_vox, glm::dvec3(128, 0, 0));
  const std::vector<glm::vec3> found = well_inside(box->mesh, 0.0f), wanted = well_inside(model.mesh, 128.0f);
  ASSERT_GT(wanted.size(), 1000u);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t v = 0; v < found.size(); ++v) ASSERT_LT(glm::length(found[v] - wanted[v]), 1e-4f);
  EXPECT_TRUE(checked(*box).manifold());
  EXPECT_FALSE(checked(*box).watertight());
  ASSERT_TRUE(write_exa(cut, *box, progress_));
  expect_equal(*box, read_exa(cut, progress_).value());
  EXPECT_EQ(read_exa_box(path, {{290, 0, 0}, {300, 9, 9}}, progress_).error().kind, ErrorKind::kUsage);
}

TEST_F(ExaFile, ABoxDoesNotLookAtOtherBricks) {
  const SurfaceModel model = bare_model_of({540, 34, 30}, 5);
  struct Case {
    GridBox box;
    std::vector<std::size_t> signs;  // whose are needed, of five bricks in a row
    std::size_t offsets;
  };
  for (const Case& c : {Case{{{270, 3, 3}, {300, 9, 9}}, {2}, 2}, Case{{{140, 3, 3}, {150, 9, 9}}, {0, 1, 2}, 1}}) {
    std::vector<ExaBlock> blocks = encoded(model);
    for (ExaBlock& block : blocks) {
      if (block.type != "SIG0" && block.type != "OFFS") continue;
      const auto parts = split_chunks(block.bytes, block.chunks, "test");
      std::vector<std::string> chunks(parts->begin(), parts->end());
      ASSERT_EQ(chunks.size(), 5u);
      for (std::size_t i = 0; i < chunks.size(); ++i)
        if (block.type == "OFFS" ? i != c.offsets : std::find(c.signs.begin(), c.signs.end(), i) == c.signs.end())
          chunks[i] = "no code at all";
      block.bytes = join_chunks(chunks);
    }
    const auto file = folder_ / "damaged.exa", whole = folder_ / "whole.exa";
    const std::string bytes = file_of(blocks);
    std::FILE* out = std::fopen(file.c_str(), "wb");
    ASSERT_NE(out, nullptr);
    ASSERT_EQ(std::fwrite(bytes.data(), 1, bytes.size(), out), bytes.size());
    std::fclose(out);
    ASSERT_TRUE(write_exa(whole, model, progress_));
    const auto a = read_exa_box(file, c.box, progress_), b = read_exa_box(whole, c.box, progress_);
    ASSERT_TRUE(a) << a.error().message;
    ASSERT_TRUE(b);
    expect_equal(*a, *b);
    EXPECT_FALSE(read_exa(file, progress_));
  }
}

}  // namespace
}  // namespace dubsar
