#include "core/base/files/atomic_file.h"
#include "core/base/files/input_file.h"
#include "core/base/numbers/bytes.h"
#include "core/base/system/parallel.h"
#include "core/exa/offsets/settle.h"
#include "core/exa/values/attributes.h"
#include "core/relief/smoothing/smooth.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST_F(ExaFile, OfAGridThatEndsWhereABrickDoesAreReadBack) {
  for (const Dims& dims : {Dims{129, 9, 8}, Dims{9, 129, 8}, Dims{9, 8, 129}, Dims{257, 9, 129}, Dims{385, 4, 4}})
    for (const int bits : {4, 9}) {
      const SurfaceModel model = sample_model(dims, Kind::kNoise, 3, true, bits);
      const auto read = decode_exa(file_of(encoded(model)), progress_);
      ASSERT_TRUE(read) << dims.x << " x " << dims.y << " x " << dims.z << ": " << read.error().message;
      expect_equal(model, *read);
    }
}

TEST_F(ExaFile, ModelReadBackEqualsTheModelWritten) {
  const Dims shapes[] = {{1, 1, 1}, {30, 1, 17}, {33, 20, 41}, {65, 3, 2}};
  unsigned seed = 0;
  for (const Dims& dims : shapes)
    for (const Kind kind : {Kind::kNoise, Kind::kBlob, Kind::kEmpty, Kind::kFull})
      for (const bool closed : {true, false})
        for (const bool quantised : {true, false}) {
          ++seed;
          SurfaceModel model = sample_model(dims, kind, seed, closed, 1 + static_cast<int>(seed % 16));
          if (quantised) {
            ASSERT_TRUE(settle_for_exa(model, {}, progress_));
          }
          const auto stats = write_exa(folder_ / "a.exa", model, progress_);
          ASSERT_TRUE(stats) << stats.error().message;
          const auto read = read_exa(folder_ / "a.exa", progress_);
          ASSERT_TRUE(read) << read.error().message << " " << dims.x << "x" << dims.y << "x" << dims.z;
          expect_equal(model, *read);
          EXPECT_EQ(file_of(encoded(*read)), *read_file_bytes(folder_ / "a.exa")) << "encode, decode, encode";
        }
}

TEST_F(ExaFile, WhatCanBeRecomputedIsLeftOutWhenNotAskedFor) {
  SurfaceModel model = sample_model({30, 30, 30}, Kind::kBlob, 8);
  ASSERT_TRUE(settle_for_exa(model, {}, progress_));
  const std::string file = file_of(encoded(model));
  const auto whole = decode_exa(file, progress_), bare = decode_exa(file, progress_, {.recompute = false});
  ASSERT_TRUE(whole && bare);
  expect_equal(model, *whole);
  EXPECT_TRUE(bare->attributes.normals.empty() && bare->attributes.k_min.empty() && bare->attributes.shape.empty());
  EXPECT_EQ(bare->attributes.ao, model.attributes.ao);
  EXPECT_TRUE(same_bytes(bare->mesh.positions, model.mesh.positions));
}

TEST_F(ExaFile, MinimalModelWithoutAttributesIsStored) {
  SurfaceModel model = sample_model({20, 20, 20}, Kind::kBlob, 3);
  model.mesh = build_quad_mesh(model.samples, progress_).value();
  model.attributes = {};
  model.quad_partition.clear();
  model.partitions.clear();
  model.provenance.clear();
  const auto stats = write_exa(folder_ / "a.exa", model, progress_);
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->blocks.size(), 8u) << "container, header, four of signs, face decisions, offsets";
  expect_equal(model, read_exa(folder_ / "a.exa", progress_).value());
}

TEST_F(ExaFile, SettlingKeepsTheSurfaceWithinTheBoundAndTwiceIsOnce) {
  // A sphere, smoothed by moving its vertices onto the exact one.
  const Dims dims{60, 56, 52};
  const glm::dvec3 centre(29.3, 27.1, 25.9);
  const double radius = 20.25;
  Volume<float> volume(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x)
        volume.at(x, y, z) = static_cast<float>(radius - glm::length(glm::dvec3(x, y, z) - centre));
  VolumeSource source(volume);
  for (const bool closed : {true, false}) {
    SurfaceModel model;
    model.samples = sample_surface(source, {.isovalue = 0.0f, .offset_bits = 4, .closed = closed}, progress_).value();
    model.mesh = build_quad_mesh(model.samples, progress_).value();
    for (glm::vec3& p : model.mesh.positions) {
      const glm::dvec3 from = glm::dvec3(p) - centre;
      p = glm::vec3(centre + from * (radius / glm::length(from)));
    }
    model.attributes.normals = vertex_normals(model.mesh, face_normals(model.mesh));
    SurfaceModel once = model;
    const auto stats = settle_for_exa(once, {.max_error = 1.0f / 16.0f}, progress_);
    ASSERT_TRUE(stats) << stats.error().message;
    std::vector<double> errors;
    for (const glm::vec3& p : once.mesh.positions)
      errors.push_back(std::abs(glm::length(glm::dvec3(p) - centre) - radius));
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors.back(), 1.0 / 16.0);
    EXPECT_LT(errors[errors.size() * 95 / 100], 1.0 / 32.0);
    EXPECT_LE(stats->max_error_vox, 1.0 / 16.0);
    EXPECT_LT(stats->normal_error_deg, 2.0);
    EXPECT_EQ(model.mesh.quads, once.mesh.quads);
    SurfaceModel twice = once;
    ASSERT_TRUE(settle_for_exa(twice, {}, progress_));
    expect_equal(once, twice);
    const auto blocks = encoded(once);
    for (const ExaBlock& block : blocks) EXPECT_TRUE(block.type != "POSN" && block.type != "NORM") << block.type;
  }
  SurfaceModel model = sample_model({20, 20, 20}, Kind::kBlob, 1);
  EXPECT_EQ(settle_for_exa(model, {.max_error = 0.0f}, progress_).error().kind, ErrorKind::kUsage);
}

TEST_F(ExaFile, ThreadsDoNotChangeTheBytes) {
  SurfaceModel model = sample_model({70, 60, 50}, Kind::kNoise, 4);
  ASSERT_TRUE(settle_for_exa(model, {}, progress_));
  set_thread_count(1);
  const std::string one = file_of(encoded(model));
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    EXPECT_TRUE(file_of(encoded(model)) == one) << threads;
    SilentProgress progress;
    expect_equal(model, decode_exa(one, progress).value());
  }
  set_thread_count(0);
}

TEST_F(ExaFile, InfoAndStatsDescribeTheFile) {
  SurfaceModel model = sample_model({33, 20, 41}, Kind::kBlob, 5);
  ASSERT_TRUE(settle_for_exa(model, {}, progress_));
  const auto stats = write_exa(folder_ / "a.exa", model, progress_);
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->bytes, static_cast<std::int64_t>(fs::file_size(folder_ / "a.exa")));
  std::int64_t sum = 0;
  for (const ExaBlockStats& block : stats->blocks) {
    sum += block.bytes;
    EXPECT_DOUBLE_EQ(block.bits_per_vertex,
                     8.0 * static_cast<double>(block.bytes) / static_cast<double>(stats->vertices));
  }
  EXPECT_EQ(sum, stats->bytes);
  const auto info = read_exa_info(folder_ / "a.exa");
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->header.dims, model.samples.dims);
  EXPECT_EQ(info->header.isovalue, 0.125f);
  EXPECT_EQ(info->header.vertices, model.mesh.vertex_count());
  EXPECT_EQ(info->header.quads, model.mesh.quad_count());
  EXPECT_EQ(info->partitions[1].name, "envelope \"inside\"");
  EXPECT_EQ(info->provenance, model.provenance);
  EXPECT_EQ(info->stats.blocks.size(), stats->blocks.size());
}

TEST_F(ExaFile, CancelLeavesTheOldFile) {
  ASSERT_TRUE(write_file_atomically(folder_ / "a.exa", "old"));
  SilentProgress progress;
  progress.cancel();
  const auto written = write_exa(folder_ / "a.exa", sample_model({30, 30, 30}, Kind::kBlob, 2), progress);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kCancelled);
  EXPECT_EQ(*read_file_bytes(folder_ / "a.exa"), "old");
  EXPECT_EQ(read_exa(folder_ / "a.exa", progress_).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(read_exa_info(folder_ / "a.exa").error().kind, ErrorKind::kBadData);
  EXPECT_EQ(read_exa(folder_ / "none.exa", progress_).error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(read_exa(folder_, progress_).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(write_exa(folder_ / "no" / "a.exa", sample_model({9, 9, 9}, Kind::kBlob, 2), progress_).error().kind,
            ErrorKind::kCannotCreate);
}

TEST_F(ExaFile, WhatNoReaderWouldTakeIsNotWritten) {
  const SurfaceModel model = sample_model({8, 8, 8}, Kind::kEmpty, 1);
  ASSERT_TRUE(write_exa(folder_ / "a.exa", model, progress_));
  const SurfaceModel wide = sample_model({1, 4096, 2048}, Kind::kEmpty, 1);
  const auto written = write_exa(folder_ / "a.exa", wide, progress_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(written.error().message, HasSubstr("1 x 4096 x 2048 grid points in a file of"));
  EXPECT_TRUE(read_exa(folder_ / "a.exa", progress_)) << "the old file stays";
}

TEST_F(ExaFile, ModelsThatContradictThemselvesAreNotWritten) {
  SurfaceModel model = sample_model({20, 20, 20}, Kind::kBlob, 2);
  const auto kind_of = [&](const SurfaceModel& broken) {
    const auto written = write_exa(folder_ / "a.exa", broken, progress_);
    EXPECT_FALSE(fs::exists(folder_ / "a.exa"));
    return written ? ErrorKind::kUsage : written.error().kind;
  };
  SurfaceModel broken = model;
  broken.attributes.ao.pop_back();
  EXPECT_EQ(kind_of(broken), ErrorKind::kInternal);
  broken = model;
  broken.attributes.shape[3] = 127;
  EXPECT_EQ(kind_of(broken), ErrorKind::kInternal);
  broken = model;
  std::swap(broken.mesh.quads[0], broken.mesh.quads[1]);
  EXPECT_EQ(kind_of(broken), ErrorKind::kInternal);
  broken = model;
  broken.mesh.positions[5].x = NAN;
  EXPECT_EQ(kind_of(broken), ErrorKind::kBadData);
  broken = model;
  broken.samples.offsets[0] = 16;
  EXPECT_EQ(kind_of(broken), ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
