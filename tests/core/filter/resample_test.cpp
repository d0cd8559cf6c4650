#include "core/filter/resample.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "core/base/system/parallel.h"
#include "tests/core/filter/filter_oracle.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

using oracle::make_volume;
using testing::read_all;

Volume<float> halved(const Volume<float>& v) {
  VolumeSource source(v);
  HalfResolutionSource half(source);
  return read_all(half, half.dims().z).value();
}

TEST(Resample, EveryAxisIsHalvedDownwardsAndTheFrameFollows) {
  for (const std::int64_t n : {1871, 999, 1723, 2, 3, 1}) {
    const Volume<float> v = make_volume({n, 1, 1}, [](auto, auto, auto) { return 0.0; });
    VolumeSource source(v, GridFrame{.scale = {3, 3, 3}, .origin_vox = {10, 20, 30}, .input_voxel = {}});
    HalfResolutionSource half(source);
    EXPECT_EQ(half.dims(), (Dims{n > 1 ? n / 2 : 1, 1, 1}));
    const bool thin = n == 1;
    EXPECT_EQ(half.frame().scale, glm::dvec3(thin ? 3 : 6, 3, 3));
    EXPECT_EQ(half.frame().origin_vox, glm::dvec3(thin ? 10 : 13, 20, 30));
  }
}

TEST(Resample, ConstantsStayTheSameToTheBit) {
  for (const float value : {0.0F, 0.0017F, -1024.3F, 3e38F}) {
    const Volume<float> half = halved(make_volume({21, 14, 9}, [&](auto, auto, auto) { return value; }));
    for (const float out : half.voxels.span()) EXPECT_EQ(out, value);
  }
}

TEST(Resample, ALinearRampIsTheSameInInputCoordinates) {
  const auto ramp = [](double x, double y, double z) { return 3.0 * x - 2.0 * y + 0.5 * z + 7.0; };
  const Volume<float> v = make_volume({41, 23, 17}, [&](auto x, auto y, auto z) {
    return ramp(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  });
  VolumeSource source(v);
  HalfResolutionSource half(source);
  const Volume<float> out = read_all(half, 3).value();
  for (std::int64_t z = 0; z < out.dims.z; ++z)
    for (std::int64_t y = 0; y < out.dims.y; ++y)
      for (std::int64_t x = 0; x < out.dims.x; ++x) {
        const glm::dvec3 p = half.frame().input_vox_from_grid({x, y, z});
        EXPECT_NEAR(out.at(x, y, z), ramp(p.x, p.y, p.z), 1e-4);
      }
}

TEST(Resample, AnImpulseSpreadsByOneTwoOne) {
  for (int where = 0; where < 64; ++where) {
    const std::int64_t ix = 4 + where % 4, iy = 4 + where / 4 % 4, iz = 4 + where / 16;
    const Volume<float> out =
        halved(make_volume({12, 12, 12}, [&](auto x, auto y, auto z) { return x == ix && y == iy && z == iz; }));
    const auto weight = [](std::int64_t sample, std::int64_t voxel) {
      const std::int64_t d = std::abs(2 * sample + 1 - voxel);
      return d == 0 ? 0.5 : d == 1 ? 0.25 : 0.0;
    };
    for (std::int64_t z = 0; z < 6; ++z)
      for (std::int64_t y = 0; y < 6; ++y)
        for (std::int64_t x = 0; x < 6; ++x) EXPECT_EQ(out.at(x, y, z), weight(x, ix) * weight(y, iy) * weight(z, iz));
  }
}

TEST(Resample, AgreesWithTheDefinitionForSmallAndOddSizes) {
  oracle::Noise noise(1);
  for (const Dims dims :
       {Dims{1, 1, 1}, Dims{2, 2, 2}, Dims{1, 5, 2}, Dims{3, 1, 4}, Dims{67, 3, 5}, Dims{130, 7, 1}}) {
    const Volume<float> v = make_volume(dims, [&](auto, auto, auto) { return noise(); });
    const Volume<float> out = halved(v);
    const auto centre = [](std::int64_t n, std::int64_t i) { return n > 1 ? 2 * i + 1 : i; };
    for (std::int64_t z = 0; z < out.dims.z; ++z)
      for (std::int64_t y = 0; y < out.dims.y; ++y)
        for (std::int64_t x = 0; x < out.dims.x; ++x)
          EXPECT_NEAR(out.at(x, y, z),
                      oracle::window_gauss(v, 3, centre(dims.x, x), centre(dims.y, y), centre(dims.z, z)), 1e-6);
  }
}

TEST(Resample, HugeValuesDoNotOverflow) {
  const float big = std::numeric_limits<float>::max();
  const Volume<float> out = halved(make_volume({64, 4, 4}, [&](auto x, auto, auto) { return x % 3 ? big : -big; }));
  for (const float value : out.voxels.span()) EXPECT_TRUE(std::isfinite(value));
}

TEST(Resample, SlabHeightAndThreadsChangeNoBit) {
  oracle::Noise noise(2);
  const Volume<float> v = make_volume({75, 53, 47}, [&](auto, auto, auto) { return noise(); });
  const Volume<float> expected = halved(v);
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    for (const std::int64_t height : {1, 2, 5, 23}) {
      VolumeSource source(v);
      HalfResolutionSource half(source);
      const Volume<float> out = read_all(half, height).value();
      EXPECT_EQ(0, std::memcmp(out.voxels.data(), expected.voxels.data(), out.voxels.span().size_bytes()))
          << threads << " threads, slabs of " << height;
    }
  }
  set_thread_count(0);
}

TEST(Resample, SlicesReadInAnyOrderAreTheSame) {
  oracle::Noise noise(3);
  const Volume<float> v = make_volume({20, 20, 40}, [&](auto, auto, auto) { return noise(); });
  const Volume<float> expected = halved(v);
  VolumeSource source(v);
  HalfResolutionSource half(source);
  Buffer<float> out(3 * 100);
  for (const std::int64_t z : {17, 3, 4, 0, 12, 11, 15, 14}) {
    ASSERT_TRUE(half.read(z, z + 3, out.span()));
    EXPECT_EQ(0, std::memcmp(out.data(), expected.row(0, z), out.span().size_bytes())) << z;
  }
}

/// Fails on the second read.
class BrokenSource final : public SlabSource {
 public:
  Dims dims() const noexcept override { return {8, 8, 400}; }
  const GridFrame& frame() const noexcept override { return frame_; }
  Result<void> read(std::int64_t, std::int64_t, std::span<float>) override {
    if (++reads_ > 1) return fail(ErrorKind::kIo, "broken");
    return {};
  }

 private:
  int reads_ = 0;
  GridFrame frame_;
};

TEST(Resample, ErrorsOfTheSourceComeThrough) {
  BrokenSource source;
  HalfResolutionSource half(source);
  const auto out = read_all(half);
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().message, "broken");
}

}  // namespace
}  // namespace dubsar
