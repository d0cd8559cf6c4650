// Fill patches of files that older versions wrote. That they are read right is golden_test.cpp's.

#include "core/exa/patches/patches.h"

#include <cmath>
#include <random>

#include "core/exa/chunks.h"
#include "core/exa/exa_decode.h"
#include "core/exa/patches/patch_disk.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {

const char* const kGoldenPatches[] = {"exa3_smoothed.exa", "exa5_evidence.exa", "exa6_rings.exa"};

std::filesystem::path golden(const char* name) { return std::filesystem::path(DUBSAR_GOLDEN) / name; }

TEST_F(ExaFile, PatchesOfAnOlderFileGoIntoTheNextAsTheyAre) {
  for (const char* const name : kGoldenPatches) {
    const SurfaceModel model = read_exa(golden(name), progress_).value();
    ASSERT_FALSE(model.patches.empty()) << name;
    const auto blocks = encoded(model);
    const auto again = decode_exa(file_of(blocks), progress_);
    ASSERT_TRUE(again) << again.error().message;
    expect_equal(model, *again);
    EXPECT_EQ(file_of(encoded(*again)), file_of(blocks)) << name;
  }
}

TEST_F(ExaFile, PatchesThatNoFileHasAreNotWritten) {
  SurfaceModel model = sample_model({12, 9, 10}, Kind::kBlob, 6);
  model.patches.push_back({0, 1, {}, {{0, 1, 2}}});
  EXPECT_EQ(encode_exa(model, progress_).error().kind, ErrorKind::kInternal);
}

TEST_F(ExaFile, DamageGivesPatchesOrAnErrorAndNeverMoreThanTheBytesHold) {
  for (const char* const name : kGoldenPatches) {
    const SurfaceModel model = read_exa(golden(name), progress_).value();
    const PatchSurroundings around{model.mesh, model.quad_partition};
    const ForeignBlock block = *std::ranges::find(model.foreign, "FILL", &ForeignBlock::type);
    const std::string whole(split_chunks(block.bytes, block.chunks, "test")->at(0));
    std::mt19937 random(8);
    for (int round = 0; round < 1000; ++round) {
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
