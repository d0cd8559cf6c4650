#include "core/rays/parallel_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {
using kernels::kLanes;

/// Gauss' bells: their line integrals are Gauss' bells.
struct Bell {
  double x, y, spread;
};

Bell bell_of(std::int64_t lane, double spread) { return {0.4 * double(lane) - 9.0, 6.0 - 0.7 * double(lane), spread}; }

LaneImage image_of_bells(const ParallelRays& rays, double spread) {
  LaneImage image = rays.image();
  for (std::int64_t y = 0; y < image.height(); ++y)
    for (std::int64_t x = 0; x < image.width(); ++x)
      for (std::int64_t lane = 0; lane < kLanes; ++lane) {
        const Bell bell = bell_of(lane, spread);
        const double dx = double(x) - 0.5 * double(image.width() - 1) - bell.x;
        const double dy = double(y) - 0.5 * double(image.height() - 1) - bell.y;
        image.at(x, y)[lane] = static_cast<float>(std::exp(-(dx * dx + dy * dy) / (2 * spread * spread)));
      }
  return image;
}

TEST(ParallelRays, ProjectionsOfABellAreBells) {
  const ParallelRays rays(80, 57, 60);
  const double spread = 4.0;
  const LaneImage image = image_of_bells(rays, spread);
  LaneSinogram projections = rays.sinogram();
  rays.project(image, projections);
  const double peak = spread * std::sqrt(2 * std::numbers::pi);
  for (std::int64_t k = 0; k < rays.directions(); ++k)
    for (std::int64_t u = 0; u < rays.bins(); ++u)
      for (const std::int64_t lane : {0, 7, 15}) {
        const Bell bell = bell_of(lane, spread);
        const double angle = std::numbers::pi * double(k) / 60.0;
        const double at = double(u) - rays.middle() - bell.x * std::cos(angle) - bell.y * std::sin(angle);
        ASSERT_NEAR(projections.row(k)[u * kLanes + lane], peak * std::exp(-at * at / (2 * spread * spread)),
                    0.01 * peak)
            << k << " " << u;
      }
}

// A ball of radius r: 2 sqrt(r^2 - u^2), but for what its pixels make of its rim.
TEST(ParallelRays, ProjectionsOfABallAreItsChords) {
  const ParallelRays rays(64, 64, 50);
  const double radius = 21.3;
  LaneImage image = rays.image();
  for (std::int64_t y = 0; y < 64; ++y)
    for (std::int64_t x = 0; x < 64; ++x) {
      int inside = 0;
      for (int k = 0; k < 100; ++k)
        inside += std::hypot(double(x) - 31.95 + 0.1 * (k % 10), double(y) - 31.95 + 0.1 * (k / 10)) < radius ? 1 : 0;
      image.at(x, y)[3] = static_cast<float>(inside / 100.0);
    }
  LaneSinogram projections = rays.sinogram();
  rays.project(image, projections);
  for (std::int64_t k = 0; k < rays.directions(); ++k)
    for (std::int64_t u = 0; u < rays.bins(); ++u) {
      const double at = double(u) - rays.middle();
      const double chord = std::abs(at) < radius ? 2 * std::sqrt(radius * radius - at * at) : 0.0;
      if (std::abs(std::abs(at) - radius) > 4.0) {  // where interpolation blurs the bend of the rim by little
        EXPECT_NEAR(projections.row(k)[u * kLanes + 3], chord, 0.35) << k << " " << u;
      }
      EXPECT_EQ(projections.row(k)[u * kLanes + 4], 0.0F);
    }
}

TEST(ParallelRays, BackprojectionGivesSmoothImagesBack) {
  const ParallelRays rays(80, 57, 90);
  for (const auto& [spread, error] : {std::pair{2.0, 0.015}, {3.0, 0.008}, {5.0, 0.004}}) {
    const LaneImage image = image_of_bells(rays, spread);
    LaneSinogram projections = rays.sinogram();
    rays.project(image, projections);
    rays.filter(projections);
    LaneImage back = rays.image();
    rays.backproject(projections, back);
    double worst = 0.0;
    for (std::int64_t y = 0; y < 57; ++y)
      for (std::int64_t x = 0; x < 80; ++x)
        for (std::int64_t lane = 0; lane < kLanes; ++lane)
          worst = std::max<double>(worst, std::abs(back.at(x, y)[lane] - image.at(x, y)[lane]));
    EXPECT_LT(worst, error) << spread;
  }
}

// With many directions, some are taken together: a bell far from the middle, and one beside the border of a tile.
TEST(ParallelRays, DirectionsTakenTogetherAreAsExact) {
  ASSERT_GT(ParallelRays::directions_together(700), 1);
  const ParallelRays rays(150, 97, 700);
  for (const auto& [spread, error] : {std::pair{1.5, 0.055}, {2.0, 0.022}, {3.0, 0.008}}) {
    const LaneImage image = image_of_bells(rays, spread);
    LaneSinogram projections = rays.sinogram();
    rays.project(image, projections);
    const double peak = spread * std::sqrt(2 * std::numbers::pi);
    for (std::int64_t k = 0; k < rays.directions(); k += 9)
      for (std::int64_t u = 0; u < rays.bins(); ++u)
        for (const std::int64_t lane : {0, 15}) {
          const Bell bell = bell_of(lane, spread);
          const double angle = std::numbers::pi * double(k) / 700.0;
          const double at = double(u) - rays.middle() - bell.x * std::cos(angle) - bell.y * std::sin(angle);
          ASSERT_NEAR(projections.row(k)[u * kLanes + lane], peak * std::exp(-at * at / (2 * spread * spread)),
                      (0.15 / spread + 0.15) / spread * peak)  // Joseph takes a 12th of spread^-2, rays are off by .25
              << spread << " " << k << " " << u;
        }
    rays.filter(projections);
    LaneImage back = rays.image();
    rays.backproject(projections, back);
    double worst = 0.0;
    for (std::int64_t y = 0; y < 97; ++y)
      for (std::int64_t x = 0; x < 150; ++x)
        for (std::int64_t lane = 0; lane < kLanes; ++lane)
          worst = std::max<double>(worst, std::abs(back.at(x, y)[lane] - image.at(x, y)[lane]));
    EXPECT_LT(worst, error) << spread;
  }
}

class ParallelRaysThreads : public testing::TestWithParam<std::int64_t> {};
INSTANTIATE_TEST_SUITE_P(FewAndManyDirections, ParallelRaysThreads, testing::Values(37, 450));

TEST_P(ParallelRaysThreads, DoNotChangeABit) {
  const ParallelRays rays(90, 41, GetParam());
  const LaneImage image = image_of_bells(rays, 3.0);
  std::vector<float> results[2];
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    LaneSinogram projections = rays.sinogram();
    rays.project(image, projections);
    rays.filter(projections);
    LaneImage back = rays.image();
    rays.backproject(projections, back);
    results[threads / 2].assign(back.at(-1, -1), back.at(0, 41));
  }
  set_thread_count(0);
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace
}  // namespace dubsar
