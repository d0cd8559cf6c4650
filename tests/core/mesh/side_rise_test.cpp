// How much a side bulges beside its writing.

#include "core/mesh/writing/side_rise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dubsar {
namespace {

/// A sheet that rises by `rise` in its middle, with round pits of .6 mm from its upper border to `written` (0..1) of
/// the way down, and a hole.
HeightMap sheet(double rise, double written, int width = 420, int height = 300) {
  HeightMap map;
  map.width = width;
  map.height = height;
  map.step_mm = 0.1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = 2.0 * x / (width - 1) - 1.0, v = 2.0 * y / (height - 1) - 1.0;
      double mm = 5.0 + 0.3 * u - 0.2 * v - 0.5 * rise * (u * u + v * v);
      const double px = std::fmod(x, 16.0) - 8.0, py = std::fmod(y, 16.0) - 8.0, r = std::hypot(px, py);
      if (1.0 - static_cast<double>(y) / height <= written && r < 5.0) mm -= 0.6 * (1.0 - r / 5.0);
      map.mm.push_back(static_cast<float>(mm));
    }
  for (int y = 40; y < 80; ++y)
    for (int x = 300; x < 350; ++x)
      map.mm[static_cast<std::size_t>(y * width + x)] = std::numeric_limits<float>::quiet_NaN();
  return map;
}

TEST(SideRise, IsThatOfTheSheetWithoutItsImpressions) {
  for (const double rise : {-1.0, 0.0, 0.5, 1.6, 3.0}) {
    const double inner = 0.8 * 0.8 * rise;
    EXPECT_NEAR(side_rise_mm(sheet(rise, 0.0)), inner, 1e-4) << "nothing written";
    EXPECT_NEAR(side_rise_mm(sheet(rise, 1.0)), inner, 0.03) << "written all over";
    EXPECT_NEAR(side_rise_mm(sheet(rise, 0.5)), inner, 0.06) << "the upper half";
  }
  HeightMap nothing = sheet(1.0, 0.0);
  nothing.mm.assign(nothing.mm.size(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(side_rise_mm(nothing), 0.0);
}

}  // namespace
}  // namespace dubsar
