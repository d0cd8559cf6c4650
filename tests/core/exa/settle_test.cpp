#include "core/exa/offsets/settle.h"

#include "core/base/system/parallel.h"
#include "core/exa/offsets/escape_choice.h"
#include "core/exa/offsets/offset_choice.h"
#include "core/exa/offsets/offsets.h"
#include "core/exa/values/exact.h"
#include "core/extract/cell_box.h"
#include "core/extract/triangulate.h"
#include "core/mesh/exact_crossings.h"
#include "core/mesh/mesh_check.h"
#include "core/relief/curvature/curvature.h"
#include "core/relief/smoothing/smooth.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {

/// A noisy blob whose vertices lie at the mean of the x-quads around them.
SurfaceModel smoothed_model(unsigned seed) {
  SurfaceModel model = sample_model({44, 41, 150}, Kind::kBlob, seed);
  SilentProgress progress;
  QuadMesh& mesh = model.mesh;
  mesh.positions = build_quad_mesh(model.samples, progress)->positions;
  const std::vector<glm::vec3> before = mesh.positions;
  for (std::size_t v = 0; v < before.size(); ++v) {
    glm::vec3 sum(0.0f);
    for (const std::uint32_t q : mesh.quads_of(static_cast<std::uint32_t>(v)))
      for (const std::uint32_t w : mesh.quads[q]) sum += 0.25f * before[w];
    mesh.positions[v] = sum / static_cast<float>(mesh.quads_of(static_cast<std::uint32_t>(v)).size());
  }
  model.attributes = {};
  model.mesh.embedded = false;  // vertices have left their cells
  return model;
}

struct Every : OffsetPrices {
  explicit Every(double price_of_step, const SurfaceSamples& samples) : step(price_of_step), wanted(samples.offsets) {}
  std::pair<int, int> range(std::uint32_t) const override { return {0, 15}; }
  void prices(std::uint32_t number, int first, int last, double* to) const override {
    for (int offset = first; offset <= last; ++offset) *to++ = step * std::abs(offset - wanted[number]);
  }
  void take(std::uint32_t number, int offset) override { taken[number] = offset; }
  double step;
  std::vector<std::uint16_t> wanted;
  std::vector<int> taken = std::vector<int>(wanted.size(), -1);
};

std::size_t offset_bytes(const SurfaceSamples& samples) {
  SilentProgress progress;
  std::size_t bytes = 0;
  const SampleCode code = encode_samples(samples, progress).value();
  for (const std::string& chunk : code.offsets) bytes += chunk.size();
  return bytes;
}

TEST(ExaSettle, OffsetsThatMayBeAnyAreThoseThatTheNetworkExpects) {
  SilentProgress progress;
  SurfaceSamples samples = sample_model({30, 140, 20}, Kind::kNoise, 21).samples;
  const std::size_t before = offset_bytes(samples);
  const SurfaceSamples original = samples;
  Every dear(1e6, samples);
  ASSERT_TRUE(choose_offsets(samples, dear, progress));
  EXPECT_TRUE(samples == original) << "none is worth a million bits";
  EXPECT_EQ(std::count(dear.taken.begin(), dear.taken.end(), -1), 0) << "every edge is asked for";
  Every free(0.0, samples);
  ASSERT_TRUE(choose_offsets(samples, free, progress));
  EXPECT_LT(offset_bytes(samples), before * 2 / 3);
}

TEST(ExaSettle, TheOffsetsOfASmoothedSurfaceAreTheSameForAnyNumberOfThreads) {
  SilentProgress progress;
  SurfaceModel first;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    SurfaceModel model = smoothed_model(5);
    const auto stats = settle_for_exa(model, {}, progress);
    ASSERT_TRUE(stats) << stats.error().message;
    EXPECT_LE(stats->max_error_vox, 1.0 / 16.0);
    EXPECT_LE(stats->p95_error_vox, 1.0 / 32.0);
    EXPECT_LT(stats->escaped_fraction, 0.1);
    if (threads == 1) first = model;
    EXPECT_TRUE(model.samples == first.samples) << threads << " threads";
    EXPECT_TRUE(same_bytes(model.mesh.positions, first.mesh.positions)) << threads << " threads";
  }
  set_thread_count(0);
}

/// From p to the triangles of all x-quads near it, cut in both ways: dense points of them, so at most .01 too large.
double distance(const QuadMesh& mesh, const glm::vec3& p) {
  double least = 1e9;
  for (const auto& quad : mesh.quads) {
    const auto at = [&](std::size_t i) { return glm::dvec3(mesh.positions[quad[i % 4]]); };
    if (glm::length(at(0) - glm::dvec3(p)) > 3.0) continue;
    for (std::size_t cut = 0; cut < 4; ++cut)
      for (int i = 0; i <= 128; ++i)
        for (int j = 0; i + j <= 128; ++j)
          least = std::min(
              least,
              glm::length((at(cut) * double(128 - i - j) + at(cut + 1) * double(i) + at(cut + 2) * double(j)) / 128.0 -
                          glm::dvec3(p)));
  }
  return least;
}

TEST(ExaSettle, VerticesThatLeaveTakeTheFewestStepsThatBringThemBack) {
  SilentProgress progress;
  SurfaceModel model = sample_model({14, 12, 13}, Kind::kBlob, 3);
  const QuadMesh base = build_quad_mesh(model.samples, progress).value();
  QuadMesh wanted = base;
  wanted.embedded = false;  // vertices leave their cells
  for (glm::vec3& p : wanted.positions) p += glm::vec3(0.02f, -0.03f, 0.1f);
  std::vector<glm::vec3> moved = base.positions;
  SettleStats stats;
  constexpr double kBound = 1.0 / 16.0;
  let_escape(wanted, vertex_normals(wanted, face_normals(wanted)), kBound, moved, stats);
  EXPECT_LE(stats.max_error_vox, kBound);
  EXPECT_LE(stats.p95_error_vox, 0.5 * kBound);
  int gone = 0, short_ones = 0, looked = 0;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const glm::vec3 k = 64.0f * (moved[v] - base.positions[v]);
    const int axes = (std::abs(k.x) > 0.5f) + (std::abs(k.y) > 0.5f) + (std::abs(k.z) > 0.5f);
    gone += axes > 0;
    short_ones += axes == 1;
    if (axes != 1 || v % 29 != 0) continue;
    ++looked;
    EXPECT_LE(distance(wanted, moved[v]), 0.5 * kBound + 0.01) << v;
    const glm::vec3 one_less = moved[v] - (moved[v] - base.positions[v]) / std::round(glm::length(k));
    EXPECT_GT(distance(wanted, one_less), 0.5 * kBound - 0.005) << v;
  }
  EXPECT_GT(gone, 100);
  EXPECT_GT(short_ones, gone * 9 / 10);
  EXPECT_GT(looked, 5);
  EXPECT_NEAR(stats.escaped_fraction, double(gone) / double(moved.size()), 1e-12);
}

TEST(ExaSettle, ASettledSurfaceCrossesItselfNowhereAlsoWhenItIsReadAgain) {
  for (const unsigned seed : {51u, 52u}) {
    Volume<float> volume({26, 22, 24});
    std::ranges::fill(volume.voxels.span(), -1.0f);
    std::mt19937 random(seed);
    for (std::int64_t z = 2; z < 22; ++z)
      for (std::int64_t y = 2; y < 20; ++y)
        for (std::int64_t x = 2; x < 24; ++x)
          volume.at(x, y, z) = 8.0f - glm::length(glm::vec3(glm::i64vec3(x, y, z)) - glm::vec3(12.5f, 10.5f, 11.5f)) +
                               (seed == 51 ? 3.0f : 30.0f) * (static_cast<float>(random() >> 8) * 0x1p-24f - 0.5f);
    VolumeSource source(volume);
    SilentProgress progress;
    SurfaceModel model;
    model.samples = sample_surface(source, {.isovalue = 0.125f}, progress).value();
    model.mesh = build_quad_mesh(model.samples, progress).value();
    ASSERT_TRUE(smooth(model.mesh, model.attributes.normals, {}, progress));
    const auto stats = settle_for_exa(model, {}, progress);
    ASSERT_TRUE(stats) << stats.error().message;
    EXPECT_EQ(stats->touching_cells, 0);
    const TriMesh mesh = make_tri_mesh(model).value();
    EXPECT_EQ(check_exactly(mesh.positions, mesh.triangles), ExactCheck{}) << seed;
    EXPECT_TRUE(check_mesh(mesh.positions, mesh.triangles).watertight()) << seed;
    const std::vector<ExaBlock> blocks = encode_exa(model, progress).value();
    const SurfaceModel read = decode_exa(file_of(blocks), progress).value();
    EXPECT_TRUE(read.mesh.embedded);
    EXPECT_EQ(make_tri_mesh(read).value().triangles, mesh.triangles) << seed;
  }
}

TEST(ExaSettle, ASettledVertexLiesAtThePlaceNextToItselfInItsCellThatAFileHolds) {
  for (const unsigned seed : {61u, 62u, 63u, 64u, 65u}) {
    SilentProgress progress;
    SurfaceModel model = sample_model({24, 21, 70}, seed % 2 == 0 ? Kind::kBlob : Kind::kNoise, seed);
    model.attributes = {};
    model.mesh = build_quad_mesh(model.samples, progress).value();
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-0.6f, 0.6f);
    for (glm::vec3& p : model.mesh.positions)  // to the walls of their cells, and to the border of the grid
      p = kept_in_cell(p, p + glm::vec3(uniform(random), uniform(random), uniform(random)));
    ASSERT_TRUE(settle_for_exa(model, {}, progress)) << seed;
    const QuadMesh base = build_quad_mesh(model.samples, progress).value();
    int gone = 0;
    for (std::size_t v = 0; v < base.positions.size(); ++v) {
      const glm::vec3 &from = base.positions[v], &place = model.mesh.positions[v];
      const auto k = escape_to(from, kept_in_cell(from, place));
      ASSERT_TRUE(k) << seed << " vertex " << v;
      EXPECT_EQ(escaped(from, *k), place) << seed << " vertex " << v;
      gone += from != place;
    }
    EXPECT_GT(gone, 100) << seed;
  }
}

TEST(ExaSettle, AFileThatNamesNoCutIsCutAsBefore) {
  SilentProgress progress;
  SurfaceModel model = sample_model({14, 12, 13}, Kind::kNoise, 3);
  model.mesh.embedded = false;
  const SurfaceModel read = decode_exa(file_of(encode_exa(model, progress).value()), progress).value();
  EXPECT_FALSE(read.mesh.embedded);
  EXPECT_EQ(triangulate(read.mesh, {}).triangles, triangulate(model.mesh, {}).triangles);
}

/// A settled model with normals and curvatures.
SurfaceModel settled_model(unsigned seed) {
  SurfaceModel model = smoothed_model(seed);
  SilentProgress progress;
  VertexAttributes& a = model.attributes;
  a.normals = vertex_normals(model.mesh, face_normals(model.mesh));
  Curvatures k = principal_curvatures(model.mesh, a.normals, CurvatureMethod::kFit, progress).value();
  a.k_min = std::move(k.k_min);
  a.k_max = std::move(k.k_max);
  EXPECT_TRUE(settle_for_exa(model, {}, progress));
  return model;
}

TEST(ExaSettle, OfWhatIsSettledNothingMoves) {
  SurfaceModel model = settled_model(7);
  SilentProgress progress;
  const auto again = settle_for_exa(model, {}, progress);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->normal_error_deg, 0.0);
  EXPECT_EQ(again->max_error_vox, 0.0);
  EXPECT_EQ(again->shape_changed_fraction, 0.0);
}

TEST(ExaSettle, WhatIsKnownToFollowIsNotComputedAgainAndTheFileIsTheSame) {
  SurfaceModel model = settled_model(5);
  ASSERT_NE(model.settled_sum, 0U);
  EXPECT_EQ(model.settled_sum, settled_sum(model));
  const std::string quick = file_of(encoded(model));
  model.settled_sum = 0;
  EXPECT_EQ(quick, file_of(encoded(model)));
}

TEST(ExaSettle, ANumberThatWasChangedSinceIsSeen) {
  const SurfaceModel settled = settled_model(6);
  const std::size_t usual = file_of(encoded(settled)).size();
  SilentProgress progress;
  for (int what = 0; what < 3; ++what) {
    SurfaceModel model = settled;
    VertexAttributes& a = model.attributes;
    const std::size_t v = a.normals.size() - 1;
    float& number = what == 0 ? a.normals[v].z : what == 1 ? a.k_min[v] : a.k_max[0];
    number = std::nextafter(number, 1.0f);
    EXPECT_NE(settled_sum(model), model.settled_sum);
    const std::string file = file_of(encoded(model));
    EXPECT_GT(file.size(), usual) << "it is stored then";
    const SurfaceModel back = decode_exa(file, progress).value();
    EXPECT_TRUE(same_bytes(back.attributes.normals, a.normals));
    EXPECT_TRUE(same_bytes(back.attributes.k_min, a.k_min));
    EXPECT_TRUE(same_bytes(back.attributes.k_max, a.k_max));
  }
}

}  // namespace
}  // namespace dubsar
