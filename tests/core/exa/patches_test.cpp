#include "core/exa/patches/patches.h"

#include <cmath>
#include <random>

#include "core/exa/patches/patch_disk.h"
#include "core/parts/fill/holes.h"
#include "tests/core/exa/exa_test_models.h"
#include "tests/core/exa/ring_patch.h"

namespace dubsar {
namespace {

/// A blob cut in two by a plane, the cut closed by fill_holes().
SurfaceModel cut_model() {
  SilentProgress progress;
  SurfaceModel model = sample_model({60, 50, 40}, Kind::kBlob, 21);
  model.mesh = build_quad_mesh(model.samples, progress).value();
  model.attributes = {};
  model.quad_partition.clear();
  for (const auto& quad : model.mesh.quads)
    model.quad_partition.push_back(
        model.mesh.positions[quad[0]].x + 0.3f * model.mesh.positions[quad[0]].y > 40.0f ? 1 : 0);
  model.partitions = {{0, "left", "", 0, 0, true}, {1, "right", "", 0, 0, true}};
  model.patches.clear();
  EXPECT_TRUE(fill_holes(model, HoleOptions{}, progress));
  EXPECT_FALSE(model.patches.empty());
  return model;
}

void expect_same(const std::vector<FillPatch>& a, const std::vector<FillPatch>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].partition, b[i].partition);
    EXPECT_EQ(a[i].reverse_partition, b[i].reverse_partition);
    EXPECT_EQ(a[i].triangles, b[i].triangles);
    EXPECT_TRUE(same_bytes(a[i].extra_positions, b[i].extra_positions));
  }
}

/// Triangles by their corners, rounded, the lowest first.
std::vector<std::array<std::array<int, 3>, 3>> corners_of(const FillPatch& patch, const QuadMesh& mesh) {
  const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
  std::vector<std::array<std::array<int, 3>, 3>> all;
  for (const Triangle& t : patch.triangles) {
    std::array<std::array<int, 3>, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3 at = t[i] < vertices ? mesh.positions[t[i]] : patch.extra_positions[t[i] - vertices];
      for (int a = 0; a < 3; ++a) c[i][static_cast<std::size_t>(a)] = static_cast<int>(std::lround(at[a] * 64.0f));
    }
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    all.push_back(c);
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(ExaPatches, SettledPatchesAreTheSameSurfaceInAnotherOrderAndTakeTenBitsATriangle) {
  const SurfaceModel model = cut_model();
  const PatchSurroundings around{model.mesh, model.quad_partition};
  std::vector<FillPatch> settled = model.patches;
  settle_patches(settled, model.mesh.vertex_count());
  std::size_t triangles = 0;
  for (std::size_t p = 0; p < settled.size(); ++p) {
    EXPECT_EQ(corners_of(settled[p], model.mesh), corners_of(model.patches[p], model.mesh));
    triangles += settled[p].triangles.size();
  }
  const auto chunks = encode_patches(settled, around);
  EXPECT_LT(8 * chunks[0].size(), 10 * triangles + 512);
  const std::vector<std::string_view> views(chunks.begin(), chunks.end());
  const auto back = decode_patches(views, around);
  ASSERT_TRUE(back) << back.error().message;
  expect_same(*back, settled);
  std::vector<FillPatch> twice = settled;
  settle_patches(twice, model.mesh.vertex_count());
  expect_same(twice, settled);
}

TEST(ExaPatches, SeveralRimsAndClosedPiecesAreCompact) {
  const SurfaceModel model = cut_model();
  const PatchSurroundings around{model.mesh, model.quad_partition};
  const auto vertices = static_cast<std::uint32_t>(model.mesh.vertex_count());
  for (const unsigned seed : {1u, 2u, 3u}) {
    const FillPatch patch = ring_patch(vertices, seed);
    std::vector<FillPatch> settled{patch};
    settle_patches(settled, vertices);
    EXPECT_EQ(corners_of(settled[0], model.mesh), corners_of(patch, model.mesh));
    std::vector<FillPatch> twice = settled;
    settle_patches(twice, vertices);
    expect_same(twice, settled);
    const auto disk = disk_of(settled[0], vertices);
    ASSERT_TRUE(disk);
    EXPECT_EQ(disk->rims, (std::vector<std::uint32_t>{12, 12, 9, 9, 1, 1, 0, 0}));
    EXPECT_EQ(std::count(disk->rim.begin(), disk->rim.end(), 123u), 2);  // where they touch
    const auto joins = std::count_if(disk->choices.begin(), disk->choices.end(), [](const DiskChoice& choice) {
      return choice.step == DiskStep::kOther && choice.distance == 0;
    });
    EXPECT_EQ(joins, 4);  // one a band, whose rims' borders become one, and one a surface vertex inside
    const auto chunks = encode_patches(settled, around);
    const std::vector<std::string_view> views(chunks.begin(), chunks.end());
    const auto back = decode_patches(views, around);
    ASSERT_TRUE(back) << back.error().message;
    expect_same(*back, settled);
    EXPECT_LT(2 * chunks[0].size(), encode_patches({patch}, around)[0].size());  // in another order: one by one
  }
}

TEST(ExaPatches, AnyOtherPatchesAreKeptAsTheyAre) {
  const SurfaceModel model = cut_model();
  const PatchSurroundings around{model.mesh, model.quad_partition};
  std::mt19937 random(3);
  std::vector<FillPatch> patches = model.patches;  // not settled
  FillPatch wild{0, 255, {}, {}};
  for (int i = 0; i < 7; ++i) wild.extra_positions.emplace_back(0.1f * static_cast<float>(random() % 100), 1e9f, -0.0f);
  for (int i = 0; i < 50; ++i) {
    Triangle t;
    for (std::uint32_t& v : t)
      v = static_cast<std::uint32_t>(random() % (static_cast<unsigned>(model.mesh.vertex_count()) + 7));
    wild.triangles.push_back(t);
  }
  patches.push_back(wild);
  patches.push_back({});
  for (const bool settled : {false, true}) {
    if (settled) settle_patches(patches, model.mesh.vertex_count());
    const auto chunks = encode_patches(patches, around);
    const std::vector<std::string_view> views(chunks.begin(), chunks.end());
    const auto back = decode_patches(views, around);
    ASSERT_TRUE(back) << back.error().message;
    expect_same(*back, patches);
  }
}

TEST(ExaPatches, DamageGivesPatchesOrAnErrorAndNeverMoreThanTheBytesHold) {
  const SurfaceModel model = cut_model();
  const PatchSurroundings around{model.mesh, model.quad_partition};
  std::vector<FillPatch> settled = model.patches;
  settled.push_back(ring_patch(static_cast<std::uint32_t>(model.mesh.vertex_count()), 4));
  settle_patches(settled, model.mesh.vertex_count());
  const std::string whole = encode_patches(settled, around)[0];
  std::mt19937 random(8);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes = whole;
    if (round % 2)
      bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
    else
      for (char& c : bytes) c = static_cast<char>(random());
    if (round % 5 == 0) bytes.resize(random() % bytes.size());
    const std::vector<std::string_view> views{bytes};
    const auto back = decode_patches(views, around);
    if (!back) {
      ASSERT_EQ(back.error().kind, ErrorKind::kBadData);
      continue;
    }
    std::size_t items = 0;
    for (const FillPatch& patch : *back) items += patch.triangles.size() + patch.extra_positions.size();
    ASSERT_LE(items, 16 * (bytes.size() + 8));
  }
}

/// Places of docs/exa.md, with divisions.
std::vector<std::array<std::int64_t, 3>> places_as_specified(const std::vector<std::array<std::int64_t, 3>>& rim,
                                                             const std::vector<Triangle>& triangles,
                                                             std::size_t vertices) {
  const auto floor_of = [](std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(std::floor(static_cast<long double>(a) / static_cast<long double>(b)));
  };
  std::vector<std::array<std::int64_t, 3>> p = rim;
  std::vector<std::vector<std::uint32_t>> around(rim.size() + vertices);
  for (const Triangle& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) around[t[c]].push_back(t[(c + 1) % 3]);
  for (std::size_t a = 0; a < 3; ++a) {
    p.resize(rim.size() + vertices);
    std::int64_t centre = 0;
    for (const auto& r : rim) centre += r[a];
    centre = floor_of(centre, static_cast<std::int64_t>(rim.size()));
    std::vector<bool> met(p.size(), false);
    std::fill_n(met.begin(), rim.size(), true);
    for (const Triangle& t : triangles) {
      if (!met[t[2]]) p[t[2]][a] = floor_of(3 * p[t[0]][a] + 3 * p[t[1]][a] + 2 * centre, 8);
      met[t[2]] = true;
    }
    for (int sweep = 0; sweep < 32; ++sweep)
      for (std::size_t v = rim.size(); v < p.size(); ++v) {
        std::int64_t sum = 0;
        for (const std::uint32_t w : around[v]) sum += p[w][a];
        p[v][a] += floor_of(3 * (floor_of(sum, static_cast<std::int64_t>(around[v].size())) - p[v][a]), 2);
      }
  }
  p.erase(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(rim.size()));
  return p;
}

TEST(ExaPatches, PlacesAreThoseOfTheSpecificationAlsoFarFromTheGrid) {
  std::mt19937_64 random(26);
  for (const std::int64_t reach : {std::int64_t{1} << 12, std::int64_t{1} << 26, std::int64_t{1} << 38})
    for (const std::uint32_t n : {3u, 7u, 40u, 1500u}) {
      std::vector<std::array<std::int64_t, 3>> rim(n);
      for (auto& r : rim)
        for (std::int64_t& x : r)
          x = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * reach)) - reach;
      // A ring of vertices inside the rim, and one in the middle, which has n neighbours.
      std::vector<Triangle> triangles;
      for (std::uint32_t i = 0; i < n; ++i) triangles.push_back({i, (i + 1) % n, n + i});
      for (std::uint32_t i = 0; i < n; ++i) triangles.push_back({n + i, (i + 1) % n, n + (i + 1) % n});
      for (std::uint32_t i = 0; i < n; ++i) triangles.push_back({n + i, n + (i + 1) % n, 2 * n});
      EXPECT_EQ(relaxed_disk(rim, triangles, n + 1), places_as_specified(rim, triangles, n + 1)) << n << " " << reach;
    }
}

}  // namespace
}  // namespace dubsar
