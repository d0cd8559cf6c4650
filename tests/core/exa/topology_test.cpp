#include "core/exa/signs/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/system/parallel.h"
#include "tests/core/exa/sign_volume.h"

namespace dubsar {
namespace {

BitVolume sphere(std::int64_t n) {
  const double c = 0.5 * static_cast<double>(n - 1);
  return volume({n, n, n}, [&](auto x, auto y, auto z) {
    return std::hypot(static_cast<double>(x) - c, static_cast<double>(y) - c, static_cast<double>(z) - c) <= 0.9 * c;
  });
}

constexpr std::uint64_t kAnyNumber = ~std::uint64_t{0};

SignCode encoded(const BitVolume& signs) {
  SilentProgress progress;
  return encode_signs(signs, progress).value();
}
std::size_t bytes_of(const SignCode& code) {
  std::size_t bytes = 0;
  for (const std::string& chunk : code.coarse) bytes += chunk.size();
  for (const auto& level : code.bricks)
    for (const std::string& chunk : level) bytes += chunk.size();
  return bytes;
}
SignChunks borrowed(const SignCode& code) {
  SignChunks chunks;
  chunks.coarse.assign(code.coarse.begin(), code.coarse.end());
  for (std::size_t level = 0; level < 3; ++level)
    chunks.bricks[level].assign(code.bricks[level].begin(), code.bricks[level].end());
  return chunks;
}

void expect_lossless(const BitVolume& signs) {
  SilentProgress progress;
  const SignCode code = encoded(signs);
  const auto decoded = decode_signs(borrowed(code), signs.dims(), 0, std::nullopt, kAnyNumber, progress);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_TRUE(*decoded == signs) << signs.dims().x << "x" << signs.dims().y << "x" << signs.dims().z;
}

const Dims kShapes[] = {{1, 1, 1},    {2, 1, 1},     {1, 2, 3},     {1, 33, 70},   {64, 64, 1},  {65, 1, 65},
                        {3, 3, 3},    {31, 33, 32},  {32, 32, 32},  {33, 33, 33},  {34, 63, 65}, {129, 5, 2},
                        {70, 40, 97}, {128, 64, 20}, {131, 260, 3}, {5, 132, 139}, {259, 2, 130}};

TEST(ExaTopology, RandomVolumesOfAnyShapeAndDensityAreLossless) {
  std::mt19937 random(3);
  for (const Dims& dims : kShapes)
    for (const unsigned density : {1u, 30u, 500u, 990u})
      expect_lossless(volume(dims, [&](auto, auto, auto) { return random() % 1000 < density; }));
}

TEST(ExaTopology, EmptyAndFullVolumesTakeNextToNothing) {
  for (const Dims& dims : kShapes) {
    expect_lossless(volume(dims, [](auto, auto, auto) { return false; }));
    expect_lossless(volume(dims, [](auto, auto, auto) { return true; }));
  }
  EXPECT_LT(bytes_of(encoded(volume({256, 256, 256}, [](auto, auto, auto) { return true; }))), 200u);
}

TEST(ExaTopology, FeaturesHiddenBetweenCoarsePointsSurvive) {
  const Dims dims{97, 80, 70};
  std::mt19937 random(5);
  for (int round = 0; round < 40; ++round) {
    const auto px = static_cast<std::int64_t>(random() % 97), py = static_cast<std::int64_t>(random() % 80),
               pz = static_cast<std::int64_t>(random() % 70);
    const bool outer = round % 2 != 0;
    expect_lossless(volume(dims, [&](auto x, auto y, auto z) { return (x == px && y == py && z == pz) != outer; }));
  }
  expect_lossless(volume(dims, [](auto x, auto y, auto z) { return (x + y + z) % 2 == 0; }));
  expect_lossless(volume(dims, [](auto x, auto, auto) { return x % 32 == 5; }));
}

TEST(ExaTopology, SphereTakesASixthOfThePapersCode) {
  // 248,426 vertices at 256^3; the paper needs .868 bits per vertex.
  const double bits = 8.0 * static_cast<double>(bytes_of(encoded(sphere(256)))) / 248426.0;
  RecordProperty("bits_per_vertex", std::to_string(bits));
  EXPECT_LT(bits, 0.15);
  expect_lossless(sphere(256));
}

TEST(ExaTopology, ThreadsDoNotChangeTheBytes) {
  const BitVolume signs = sphere(300);
  set_thread_count(1);
  const SignCode one = encoded(signs);
  set_thread_count(7);
  const SignCode seven = encoded(signs);
  EXPECT_EQ(seven.coarse, one.coarse);
  EXPECT_EQ(seven.bricks, one.bricks);
  expect_lossless(signs);
  set_thread_count(0);
}

TEST(ExaTopology, CoarseLevelsAreEverySecondFourthAndEighthPoint) {
  SilentProgress progress;
  std::mt19937 random(6);
  for (const Dims& dims : {Dims{150, 131, 70}, Dims{257, 9, 129}, Dims{1, 1, 1}}) {
    const BitVolume signs = volume(dims, [&](auto x, auto y, auto z) {
      return std::hypot(double(x) - 60, double(y) - 50, double(z) - 40) < 45 + double(random() % 3);
    });
    SignCode code = encoded(signs);
    for (int level = 3; level >= 1; --level) {
      SignChunks chunks = borrowed(code);
      for (int finer = 0; finer < level && finer < 3; ++finer) chunks.bricks[static_cast<std::size_t>(finer)].clear();
      const auto decoded = decode_signs(chunks, dims, level, std::nullopt, kAnyNumber, progress);
      ASSERT_TRUE(decoded) << decoded.error().message;
      ASSERT_EQ(decoded->dims(), level_dims(dims, level));
      const Dims& d = decoded->dims();
      for (std::int64_t z = 0; z < d.z; ++z)
        for (std::int64_t y = 0; y < d.y; ++y)
          for (std::int64_t x = 0; x < d.x; ++x)
            ASSERT_EQ(decoded->get(x, y, z), signs.get(x << level, y << level, z << level)) << level;
    }
  }
}

TEST(ExaTopology, ABoxIsReadFromItsOwnBricksAndThoseThatTheyKnow) {
  SilentProgress progress;
  const Dims dims{300, 200, 140};
  const BitVolume signs = volume(dims, [&](auto x, auto y, auto z) { return (x / 3 + y / 5 + z / 4) % 9 < 4; });
  const SignCode code = encoded(signs);
  struct Case {
    std::int64_t brick;              // of 3 x 2 x 2
    std::vector<std::size_t> known;  // with those beside it, if it is a late one
  };
  for (const Case& c : {Case{0, {0}}, Case{1, {0, 1, 2, 4, 7}}, Case{2, {2}}}) {
    SignChunks chunks = borrowed(code);
    for (auto& level : chunks.bricks)
      for (std::size_t i = 0; i < level.size(); ++i)
        if (std::find(c.known.begin(), c.known.end(), i) == c.known.end()) level[i] = "\xff damaged";
    const std::int64_t low = 128 * c.brick, high = std::min<std::int64_t>(low + 128, 299);
    const GridBox box{{low + 1, 1, 1}, {high - 2, 100, 100}};
    const std::vector<std::uint8_t> needed = bricks_of_box(dims, box, true);
    for (std::size_t i = 0; i < needed.size(); ++i)
      EXPECT_EQ(needed[i] != 0, std::find(c.known.begin(), c.known.end(), i) != c.known.end()) << i;
    const auto decoded = decode_signs(chunks, dims, 0, box, kAnyNumber, progress);
    ASSERT_TRUE(decoded) << decoded.error().message;
    for (std::int64_t z = 0; z <= 128; ++z)
      for (std::int64_t y = 0; y <= 128; ++y)
        for (std::int64_t x = low; x <= high; ++x) ASSERT_EQ(decoded->get(x, y, z), signs.get(x, y, z));
  }
}

TEST(ExaTopology, BricksBesideEachOtherCodeTheirSideOnce) {
  // A slab that crosses two bricks only in their common side: the second one has nothing to say about that side.
  const Dims dims{257, 129, 129};
  std::mt19937 random(17);
  const BitVolume signs = volume(dims, [&](auto x, auto, auto) { return x == 128 && random() % 2 != 0; });
  const SignCode code = encoded(signs);
  EXPECT_GT(code.bricks[0][0].size(), 1000u);
  EXPECT_LT(code.bricks[0][1].size(), code.bricks[0][0].size() / 2) << "only the points next to the side";
  expect_lossless(signs);
}

TEST(ExaTopology, DamagedCodesAreRefusedOrGiveAVolumeButNeverCrash) {
  SilentProgress progress;
  std::mt19937 random(9);
  const Dims dims{70, 40, 97};
  const BitVolume signs = volume(dims, [&](auto x, auto y, auto z) { return (x * y + z * 3) % 17 < 9; });
  const SignCode code = encoded(signs);
  for (int round = 0; round < 200; ++round) {
    SignCode damaged = code;
    auto& level = round % 4 == 3 ? damaged.coarse : damaged.bricks[static_cast<std::size_t>(round % 4)];
    std::string& bytes = level[random() % level.size()];
    if (bytes.empty()) continue;
    if (round % 2)
      bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
    else
      bytes.resize(random() % bytes.size());
    const auto decoded = decode_signs(borrowed(damaged), dims, 0, std::nullopt, kAnyNumber, progress);
    if (!decoded) {
      EXPECT_EQ(decoded.error().kind, ErrorKind::kBadData);
    }
  }
  EXPECT_EQ(decode_signs(borrowed(code), {65, 40, 970}, 0, std::nullopt, kAnyNumber, progress).error().kind,
            ErrorKind::kBadData);
  EXPECT_EQ(decode_signs(borrowed(code), dims, 0, std::nullopt, 100, progress).error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
