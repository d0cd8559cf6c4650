#include "core/filter/histogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "core/base/system/parallel.h"
#include "tests/core/filter/filter_oracle.h"

namespace dubsar {
namespace {

using oracle::make_volume;

ValueCounts counted(const Volume<float>& v) {
  VolumeSource source(v);
  SilentProgress silent;
  auto counts = count_values(source, silent);
  EXPECT_TRUE(counts);
  return *std::move(counts);
}

TEST(ValueCounts, SmallIntegersAreExactAndInOrder) {
  ValueCounts counts;
  for (int value = -300; value <= 300; ++value) {
    const std::vector<float> same(static_cast<std::size_t>(value + 301), static_cast<float>(value));
    counts.add(same);
  }
  const auto values = counts.values();
  ASSERT_EQ(values.size(), 601U);
  for (int i = 0; i <= 600; ++i) {
    EXPECT_EQ(values[static_cast<std::size_t>(i)].centre, i - 300);
    EXPECT_EQ(values[static_cast<std::size_t>(i)].count, i + 1);
  }
  EXPECT_EQ(counts.min(), -300.0F);
  EXPECT_EQ(counts.max(), 300.0F);
}

TEST(ValueCounts, EveryValueIsKeptToFifteenBits) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(value) || std::abs(value) < 1e-36F) continue;
    ValueCounts counts;
    counts.add({&value, 1});
    ASSERT_EQ(counts.values().size(), 1U);
    EXPECT_NEAR(counts.values()[0].centre, value, std::abs(value) * 0x1p-15);
    if (i > 200) break;
  }
}

TEST(ValueCounts, NotFiniteValuesAreLeftOut) {
  const float bad[] = {
      std::nanf(""), std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), -0.0F,
      0.0F,          std::numeric_limits<float>::max()};
  ValueCounts counts;
  counts.add(bad);
  EXPECT_EQ(counts.count(), 3);
  ASSERT_EQ(counts.values().size(), 2U);
  EXPECT_EQ(counts.values()[0].centre, 0.0);
  EXPECT_EQ(counts.values()[0].count, 2);
}

/// One value after the other, by the definition: 24 bits of the pattern, in the order of the floats.
TEST(ValueCounts, BatchesWithAndWithoutBadValuesCountWhatIsThere) {
  std::mt19937 random(3);
  for (const int bad_in : {0, 100, 3}) {
    std::vector<float> values(5000);
    std::map<double, std::int64_t> expected;
    std::int64_t bad = 0;
    for (float& value : values) {
      value = std::bit_cast<float>(static_cast<std::uint32_t>(random()) & 0xFFFFFF00U & ~0x40000000U);
      if (bad_in > 0 && random() % static_cast<unsigned>(bad_in) == 0)
        value = random() % 2 == 0 ? std::nanf("") : -std::numeric_limits<float>::infinity();
      if (std::isfinite(value))
        ++expected[std::abs(value)];
      else
        ++bad;
    }
    ValueCounts counts;
    counts.add(values);
    EXPECT_EQ(counts.count(), 5000 - bad);
    std::map<double, std::int64_t> found;
    double before = -std::numeric_limits<double>::infinity();
    for (const ValueCounts::Value& v : counts.values()) {
      EXPECT_GT(v.centre, before);
      before = v.centre;
      // Positive centres are the last of 256 patterns of their counter, negative ones the first.
      const std::uint32_t bits = std::bit_cast<std::uint32_t>(static_cast<float>(v.centre)) & 0x7FFFFF00U;
      found[std::bit_cast<float>(bits)] += v.count;
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(Histogram, ThreadsChangeNoBit) {
  oracle::Noise noise(2);
  const Volume<float> v = make_volume({61, 53, 47}, [&](auto, auto, auto) { return noise(); });
  set_thread_count(1);
  const Histogram expected = make_histogram(counted(v));
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    const Histogram h = make_histogram(counted(v));
    EXPECT_EQ(h.low, expected.low);
    EXPECT_EQ(h.width, expected.width);
    EXPECT_EQ(h.mass, expected.mass);
  }
  set_thread_count(0);
}

// A volume of a thousand million voxels, of which some slices are added: every value says in which row it lies.
TEST(ParallelCounts, OfALargeVolumeTheSameTenthOfTheRowsCountsWhateverTheSlabs) {
  const Dims large{1000, 1000, 1000};
  constexpr std::int64_t kSlices = 6;
  std::vector<float> slices(static_cast<std::size_t>(large.slice() * kSlices));
  for (std::size_t i = 0; i < slices.size(); ++i) slices[i] = static_cast<float>(i / 1000);
  const auto count_by = [&](std::int64_t height, int threads) {
    set_thread_count(threads);
    ParallelCounts counts(large);
    for (std::int64_t z = 0; z < kSlices; z += height)
      counts.add(z, std::span<const float>(slices).subspan(static_cast<std::size_t>(z * large.slice()),
                                                           static_cast<std::size_t>(height * large.slice())));
    set_thread_count(0);
    const ValueCounts all = counts.take();
    EXPECT_EQ(all.count(), large.slice() * kSlices / 10);
    std::map<double, std::int64_t> by_value;
    for (const auto& value : all.values()) by_value[value.centre] = value.count;
    return by_value;
  };
  const auto whole = count_by(6, 1);
  EXPECT_EQ(whole, count_by(1, 2));
  EXPECT_EQ(whole, count_by(3, 7));
  for (const auto& [row, count] : whole) EXPECT_EQ(count % 1000, 0) << "a part of row " << row;
}

TEST(Histogram, TheRangeLeavesTheTailsOut) {
  // 100,000 values rising from 0 to 1 and ten wild ones: the quantiles .01 % and 99.99 % do not see these.
  const Volume<float> v = make_volume({100, 100, 10}, [](auto x, auto y, auto z) {
    const auto i = static_cast<double>((z * 100 + y) * 100 + x);
    return i < 5 ? -1e9 : i > 99994 ? 1e20 : i / 1e5;
  });
  const Histogram h = make_histogram(counted(v), 1000);
  EXPECT_NEAR(h.low, 0.0001 - 0.02, 1e-3);
  EXPECT_NEAR(h.low + 1000 * h.width, 0.9999 + 0.02, 1e-3);
  EXPECT_EQ(h.total, 100000.0);
  for (int bin = 30; bin < 970; ++bin) EXPECT_NEAR(h.mass[static_cast<std::size_t>(bin)], 104.0, 2.0) << bin;
}

TEST(Histogram, NoMassIsLostAndNoCombIsLeftOfIntegers) {
  const Volume<float> v = make_volume({64, 64, 64}, [](auto x, auto y, auto) { return (x + y) % 64; });
  const Histogram h = make_histogram(counted(v), 1024);
  EXPECT_NEAR(std::accumulate(h.mass.begin(), h.mass.end(), 0.0), 262144.0, 2100.0);  // the outer half steps may be cut
  for (std::size_t bin = 40; bin < 980; ++bin) EXPECT_NEAR(h.mass[bin], 4096.0 * h.width, 1e-6 * 4096.0) << bin;
}

TEST(Histogram, OneValueHasNoBins) {
  const Volume<float> v = make_volume({5, 5, 5}, [](auto, auto, auto) { return 2.5; });
  const Histogram h = make_histogram(counted(v));
  EXPECT_TRUE(h.mass.empty());
  EXPECT_EQ(h.low, 2.5);
}

TEST(Histogram, AFewOtherVoxelsAreSeenInAConstantVolume) {
  const Volume<float> v = make_volume({50, 50, 50}, [](auto x, auto y, auto z) { return x + y + z == 0 ? 9.0 : 1.0; });
  const Histogram h = make_histogram(counted(v));
  ASSERT_FALSE(h.mass.empty());
  EXPECT_LT(h.low, 1.0);
  EXPECT_GT(h.low + h.width * 2048, 9.0);
}

}  // namespace
}  // namespace dubsar
