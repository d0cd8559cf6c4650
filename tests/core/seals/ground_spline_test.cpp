// Ground that is known, under discs and breaks that are known.

#include "core/seals/ground_spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dubsar {
namespace {

constexpr double kGroundStep = 0.2, kDiscMm = 0.4;
constexpr GroundRaster kGroundRaster{201, 86, kGroundStep};

/// As hands leave clay: waves of 9 mm and more.
double clay(double x, double y) {
  return 0.16 * std::sin(6.2832 * (x + 0.5 * y) / 11.0) + 0.12 * std::cos(6.2832 * (y - 0.3 * x) / 13.0) + 0.02 * x;
}

struct Disc {
  double x, y, radius;
};
constexpr Disc kDiscs[] = {{6, 8, 1.6}, {14, 5, 1.2}, {14, 11, 1.7}, {27, 8, 1.5}, {33, 12, 1.0}};

bool in_disc(double x, double y) {
  for (const Disc& d : kDiscs)
    if (std::hypot(x - d.x, y - d.y) < d.radius) return true;
  return false;
}
bool broken_away(double x, double y) { return std::hypot((x - 21.0) / 1.3, (y - 9.0) / 4.0) < 1.0; }

TEST(GroundSpline, GoesUnderFiguresAndOverBreaks) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 0.02);
    std::vector<float> mm;
    for (int y = 0; y < kGroundRaster.height; ++y)
      for (int x = 0; x < kGroundRaster.width; ++x) {
        const double px = kGroundStep * x, py = kGroundStep * y;
        mm.push_back(static_cast<float>(clay(px, py) + noise(random) +
                                        (broken_away(px, py) ? -0.35 : (in_disc(px, py) ? kDiscMm : 0.0))));
      }
    const auto ground = ground_under(mm, std::vector<float>(mm.size(), 1.0f), kGroundRaster, 0.3);
    ASSERT_EQ(ground.size(), mm.size());
    double open = 0.0, under = 0.0, over = 0.0, opens = 0.0, unders = 0.0, overs = 0.0;
    for (int y = 0; y < kGroundRaster.height; ++y)
      for (int x = 0; x < kGroundRaster.width; ++x) {
        const double px = kGroundStep * x, py = kGroundStep * y,
                     off = static_cast<double>(ground[static_cast<std::size_t>(y * kGroundRaster.width + x)]) -
                           clay(px, py),
                     off2 = off * off;
        if (broken_away(px, py))
          over += off2, overs += 1.0;
        else if (in_disc(px, py))
          under += off2, unders += 1.0;
        else
          open += off2, opens += 1.0;
      }
    // Marks of discs are .4 mm, of the break .35: what a mean over some millimetres would leave is .1 and more.
    EXPECT_LT(std::sqrt(open / opens), 0.02) << seed;
    EXPECT_LT(std::sqrt(under / unders), 0.06) << seed;
    EXPECT_LT(std::sqrt(over / overs), 0.15) << seed;
  }
}

TEST(GroundSpline, IsTheSameForABandThatStandsUpright) {
  constexpr GroundRaster kLying{61, 41, 0.25}, kStanding{41, 61, 0.25};
  std::vector<float> lying, standing(61 * 41), all(61 * 41, 1.0f);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 61; ++x) {
      const double px = 0.25 * x, py = 0.25 * y;
      lying.push_back(static_cast<float>(clay(px, py) + (std::hypot(px - 7, py - 5) < 1.5 ? 0.4 : 0.0)));
      standing[static_cast<std::size_t>(x * 41 + y)] = lying.back();
    }
  const auto a = ground_under(lying, all, kLying, 0.3), b = ground_under(standing, all, kStanding, 0.3);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 61; ++x)
      ASSERT_NEAR(a[static_cast<std::size_t>(y * 61 + x)], b[static_cast<std::size_t>(x * 41 + y)], 1e-4f);
}

TEST(GroundSpline, CrossesWhatNobodyMeasured) {
  std::vector<float> mm, measured;
  for (int y = 0; y < kGroundRaster.height; ++y)
    for (int x = 0; x < kGroundRaster.width; ++x) {
      const double px = kGroundStep * x, py = kGroundStep * y;
      const bool hole = std::hypot(px - 20.0, py - 8.5) < 2.0;
      mm.push_back(hole ? 0.0f : static_cast<float>(3.0 + 0.05 * px - 0.02 * py));
      measured.push_back(hole ? 0.0f : 1.0f);
    }
  const auto ground = ground_under(mm, measured, kGroundRaster, 0.3);
  for (int y = 0; y < kGroundRaster.height; ++y)  // a plane bends nowhere
    for (int x = 0; x < kGroundRaster.width; ++x)
      ASSERT_NEAR(ground[static_cast<std::size_t>(y * kGroundRaster.width + x)],
                  3.0 + 0.05 * kGroundStep * x - 0.02 * kGroundStep * y, 0.01)
          << x << " " << y;
}

}  // namespace
}  // namespace dubsar
