#include "core/exa/topology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/parallel.h"

namespace dubsar {
namespace {

template <class Inside>
BitVolume volume(const Dims& dims, const Inside& inside) {
  BitVolume signs(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) signs.set(x, y, z, inside(x, y, z));
  return signs;
}

BitVolume sphere(std::int64_t n) {
  const double c = 0.5 * static_cast<double>(n - 1);
  return volume({n, n, n}, [&](auto x, auto y, auto z) {
    return std::hypot(static_cast<double>(x) - c, static_cast<double>(y) - c, static_cast<double>(z) - c) <= 0.9 * c;
  });
}

std::string encoded(const BitVolume& signs) {
  SilentProgress progress;
  return encode_signs(signs, progress).value();
}

void expect_lossless(const BitVolume& signs) {
  SilentProgress progress;
  const std::string bytes = encoded(signs);
  const auto decoded = decode_signs(bytes, signs.dims(), progress);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_TRUE(*decoded == signs) << signs.dims().x << "x" << signs.dims().y << "x" << signs.dims().z;
}

const Dims kShapes[] = {{1, 1, 1},    {2, 1, 1},   {1, 2, 3},    {1, 33, 70},  {64, 64, 1},
                        {65, 1, 65},  {3, 3, 3},   {31, 33, 32}, {32, 32, 32}, {33, 33, 33},
                        {34, 63, 65}, {129, 5, 2}, {70, 40, 97}, {128, 64, 20}};

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
  EXPECT_LT(encoded(volume({256, 256, 256}, [](auto, auto, auto) { return true; })).size(), 200u);
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

TEST(ExaTopology, SphereTakesLessThanHalfOfThePapersCode) {
  // 248,426 vertices at 256^3; the paper needs .868 bits per vertex.
  const double bits = 8.0 * static_cast<double>(encoded(sphere(256)).size()) / 248426.0;
  RecordProperty("bits_per_vertex", std::to_string(bits));
  EXPECT_LT(bits, 0.37);
  expect_lossless(sphere(256));
}

TEST(ExaTopology, ThreadsDoNotChangeTheBytes) {
  const BitVolume signs = sphere(100);
  set_thread_count(1);
  const std::string one = encoded(signs);
  set_thread_count(7);
  EXPECT_EQ(encoded(signs), one);
  set_thread_count(0);
}

TEST(ExaTopology, DamagedCodesAreRefusedOrGiveAnotherVolumeButNeverCrash) {
  SilentProgress progress;
  std::mt19937 random(9);
  const Dims dims{70, 40, 97};
  const BitVolume signs = volume(dims, [&](auto x, auto y, auto z) { return (x * y + z * 3) % 17 < 9; });
  const std::string bytes = encoded(signs);
  for (std::size_t length = 0; length < bytes.size(); length += bytes.size() / 64 + 1)
    EXPECT_FALSE(decode_signs(bytes.substr(0, length), dims, progress)) << length;
  EXPECT_FALSE(decode_signs(bytes + '\0', dims, progress));
  for (int round = 0; round < 80; ++round) {
    std::string damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<char>(1u << random() % 8);
    const auto decoded = decode_signs(damaged, dims, progress);
    if (decoded)
      EXPECT_FALSE(*decoded == signs);
    else
      EXPECT_EQ(decoded.error().kind, ErrorKind::kBadData);
  }
  for (const Dims& other : kShapes) decode_signs(bytes, other, progress);
  EXPECT_EQ(decode_signs(bytes, {65535, 65535, 16}, progress).error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
