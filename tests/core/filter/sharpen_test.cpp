#include "core/filter/sharpen.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/system/parallel.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

Volume<float> make(Dims dims, const std::function<double(double, double, double)>& f) {
  Volume<float> volume(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x)
        volume.at(x, y, z) =
            static_cast<float>(f(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)));
  return volume;
}

Volume<float> sharpened(const Volume<float>& volume, float amount, std::int64_t slab) {
  VolumeSource source(volume);
  const std::unique_ptr<SlabSource> sharp = make_sharpened(source, amount);
  return testing::read_all(*sharp, slab).value();
}

TEST(Sharpen, ConstantsAndRampsStayAsTheyAre) {
  const Volume<float> ramp = make({9, 8, 7}, [](double x, double y, double z) { return 3.0 + x - 2.0 * y + 0.5 * z; });
  const Volume<float> out = sharpened(ramp, 1.0f, 3);
  for (std::int64_t z = 1; z < 6; ++z)
    for (std::int64_t y = 1; y < 7; ++y)
      for (std::int64_t x = 1; x < 8; ++x) EXPECT_NEAR(out.at(x, y, z), ramp.at(x, y, z), 1e-5);
}

TEST(Sharpen, AWaveIsRaisedByWhatTheGaussianTakesFromIt) {
  const double k = 2.0 * M_PI / 8.0;
  const Volume<float> wave = make({33, 5, 5}, [&](double x, double, double) { return std::cos(k * (x - 16.0)); });
  const double kept = 0.5 + 0.5 * std::cos(k);  // of [1 2 1] / 4
  EXPECT_NEAR(sharpened(wave, 1.4f, 5).at(16, 2, 2), 1.0 + 1.4 * (1.0 - kept), 1e-5);
}

TEST(Sharpen, TheWideOneRaisesWavesOfAWedgeByWhatTheBlurTook) {
  const double k = 2.0 * M_PI / 6.0;
  for (const double blur : {0.7, 0.9, 1.1}) {  // variances
    const double left = std::exp(-0.5 * blur * k * k);
    const Volume<float> wave =
        make({49, 9, 9}, [&](double x, double, double) { return left * std::cos(k * (x - 24.0)); });
    VolumeSource source(wave);
    const float amount = wide_sharpening(blur, 40.0, 0.0f);
    EXPECT_NEAR(testing::read_all(*make_widely_sharpened(source, amount, 10.0f)).value().at(24, 4, 4), 1.0, 1e-4);
  }
}

TEST(Sharpen, GoodScansNeedNoWideOneAndNoisyOnesGetNone) {
  EXPECT_EQ(wide_sharpening(0.35, 40.0, 0.0f), 0.0f);
  EXPECT_EQ(wide_sharpening(0.55, 25.0, 0.45f), 0.0f);  // of the recipe at 17 dB
  EXPECT_EQ(wide_sharpening(1.0, 15.0, 0.0f), 0.0f);
  EXPECT_NEAR(wide_sharpening(1.0, 19.0, 0.0f), 0.5f * wide_sharpening(1.0, 22.0, 0.0f), 1e-6);
  EXPECT_LE(wide_sharpening(50.0, 30.0, 0.0f), 1.5f);
}

TEST(Sharpen, TheWideOneMovesSurfacesAndMakesNone) {
  // A film of air so thin that it stays above the level, clay on both sides, air beyond.
  const auto scan = make({40, 12, 12}, [](double x, double, double) {
    return (x < 30.0 ? 1.0 : 0.0) - 0.45 * std::exp(-0.5 * (x - 12.0) * (x - 12.0));
  });
  VolumeSource source(scan);
  const Volume<float> free = testing::read_all(*make_widely_sharpened(source, 1.0f, -10.0f)).value();
  const Volume<float> held = testing::read_all(*make_widely_sharpened(source, 1.0f, 0.5f)).value();
  EXPECT_LT(free.at(12, 6, 6), 0.5f);
  for (std::int64_t x = 0; x < 29; ++x) {
    EXPECT_GE(held.at(x, 6, 6), 0.5f) << x;
    if (x != 12) {
      EXPECT_EQ(held.at(x, 6, 6), free.at(x, 6, 6)) << x;
    }
  }
  for (std::int64_t x = 29; x < 40; ++x) EXPECT_EQ(held.at(x, 6, 6), free.at(x, 6, 6)) << x;
}

TEST(Sharpen, TheHalfLevelOfAPlanarEdgeKeepsItsPlace) {
  const Volume<float> edge =
      make({24, 5, 5}, [](double x, double, double) { return 0.5 * (1.0 + std::tanh((x - 11.3) / 1.5)); });
  const Volume<float> out = sharpened(edge, 1.0f, 5);
  const auto crossing = [](const Volume<float>& v) {
    std::int64_t x = 0;
    while (v.at(x + 1, 2, 2) < 0.5f) ++x;
    return static_cast<double>(x) + (0.5 - v.at(x, 2, 2)) / (v.at(x + 1, 2, 2) - v.at(x, 2, 2));
  };
  EXPECT_NEAR(crossing(out), crossing(edge), 0.01);
}

TEST(Sharpen, SlabsAndThreadsDoNotChangeTheBytes) {
  const Volume<float> volume = make({17, 9, 11}, [](double x, double y, double z) { return std::sin(x * y + z); });
  const Volume<float> whole = sharpened(volume, 1.0f, 11);
  for (const int threads : {1, 2, 7})
    for (const std::int64_t slab : {1, 2, 5}) {
      set_thread_count(threads);
      const Volume<float> parts = sharpened(volume, 1.0f, slab);
      for (std::int64_t i = 0; i < whole.voxels.size(); ++i) ASSERT_EQ(parts.voxels[i], whole.voxels[i]);
    }
  set_thread_count(0);
}

}  // namespace
}  // namespace dubsar
