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
