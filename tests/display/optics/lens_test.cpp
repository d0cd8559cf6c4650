#include "display/optics/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "display/optics/weave.h"
#include "tests/display/reference_pictures.h"

namespace dubsar {
namespace {
using testing::row_light;
using testing::view_weights;
using testing::weave_views;

LookingGlassFigures go() {
  LookingGlassFigures f;
  f.pitch = 80.74475, f.slope = -6.658777, f.dpi = 491.0, f.screen_width = 1440, f.screen_height = 2560;
  return f;
}
LookingGlassFigures portrait() {
  LookingGlassFigures f;
  f.pitch = 52.594383, f.slope = -7.211529, f.dpi = 324.0, f.screen_width = 1536, f.screen_height = 2048;
  return f;
}

TEST(LensSheet, RealCalibrationsGiveTheKnownPeriodsAndTilt) {
  EXPECT_NEAR(lens_sheet(go()).periods, 234.1814, 5e-4);
  EXPECT_NEAR(lens_sheet(go()).tilt, -0.266983, 5e-7);
  EXPECT_NEAR(lens_sheet(portrait()).periods, 246.9732, 5e-4);
  EXPECT_NEAR(lens_sheet(portrait()).tilt, -0.184889, 5e-7);
}

TEST(LensSheet, PortraitHasNearlyNineteenSubpixelsPerLens) {
  EXPECT_NEAR(3.0 * 1536 / lens_sheet(portrait()).periods, 18.7, 0.05);
  EXPECT_NEAR(3.0 * 1440 / lens_sheet(go()).periods, 18.4, 0.05);
}

TEST(LensSheet, FlippingTheImageNegatesTiltAndSubpixelOrder) {
  LookingGlassFigures f = portrait();
  const LensSheet plain = lens_sheet(f);
  f.flip_image_x = true;
  const LensSheet flipped = lens_sheet(f);
  EXPECT_DOUBLE_EQ(flipped.tilt, -plain.tilt);
  EXPECT_DOUBLE_EQ(flipped.subpixels.offset_px(0, 0, 2).x, -2.0 / 3.0);
  f.flip_image_x = false;
  f.flip_subpixels = true;
  EXPECT_DOUBLE_EQ(lens_sheet(f).subpixels.offset_px(0, 0, 0).x, 2.0 / 3.0);
}

TEST(LensSheet, PhaseMatchesTheFormulaSubpixelBySubpixel) {
  LookingGlassFigures f = portrait();
  f.center = 0.31;
  const LensSheet sheet = lens_sheet(f);
  for (int channel = 0; channel < 3; ++channel) {
    const double u = 100.5 / 1536, v = 200.5 / 2048, subp = 1.0 / (3.0 * 1536);
    const double a = (u + channel * subp + v * sheet.tilt) * sheet.periods - 0.31;
    EXPECT_NEAR(lens_position(sheet, 100, 200, channel), 1.0 - (a - std::floor(a)), 1e-9);
  }
}

TEST(LensSheet, APitchErrorOfATenthOfAPercentMovesFiveViews) {
  LookingGlassFigures f = portrait();
  const LensSheet sheet = lens_sheet(f);
  f.pitch *= 1.001;
  const LensSheet wrong = lens_sheet(f);
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < 2048; y += 8)
    for (int x = 0; x < 1536; x += 3, ++count) {
      const double d = lens_position(sheet, x, y, 0) - lens_position(wrong, x, y, 0);
      sum += std::abs(d - std::round(d)) * 48.0;
    }
  EXPECT_NEAR(sum / count, 5.0, 0.6);
}

TEST(SubpixelLayout, CellPatternsFollowTheVendorsNumbering) {
  EXPECT_EQ(cell_index(CellPattern::kUniform, 4, 5, 3), 0);
  EXPECT_EQ(cell_index(CellPattern::kCheckerboard, 2, 5, 3), 0);
  EXPECT_EQ(cell_index(CellPattern::kCheckerboard, 2, 5, 4), 1);
  EXPECT_EQ(cell_index(CellPattern::kColumns, 2, 5, 4), 1);
  EXPECT_EQ(cell_index(CellPattern::kShiftedRows, 4, 1, 3), 1);
  EXPECT_EQ(cell_index(CellPattern::kShiftedRows, 4, 0, 3), 3);
  EXPECT_EQ(cell_index(CellPattern::kRows, 2, 1, 3), 1);
  EXPECT_EQ(cell_index(CellPattern::kRows, 1, 1, 3), 0);
}

TEST(ViewWeights, SumToOneAndCentreOnTheView) {
  for (const ViewFilter filter :
       {ViewFilter::kNearest, ViewFilter::kLinear, ViewFilter::kGaussian3, ViewFilter::kGaussian10})
    for (const double position : {0.0, 0.001, 0.37, 0.5, 0.999}) {
      double sum = 0.0;
      for (const auto& [view, weight] : view_weights(position, 48, filter, 0.02)) {
        EXPECT_GE(view, 0);
        EXPECT_LT(view, 48);
        sum += weight;
      }
      EXPECT_NEAR(sum, 1.0, 1e-12);
    }
  const auto linear = view_weights(10.25 / 48.0, 48, ViewFilter::kLinear);
  EXPECT_EQ(linear[0].view, 10);
  EXPECT_NEAR(linear[1].weight, 0.25, 1e-9);
}

/// The maker's weave (looking-glass-webxr, GaussianViewFiltering): weights exp(-(g - floor(g N + i) / N)^2 / (2
/// sigma^2)).
TEST(ViewWeights, GaussiansAreThoseOfTheMakersWeave) {
  for (const int views : {5, 45, 48, 66})
    for (const double g : {0.105, 0.3, 0.4999, 0.77}) {
      for (const auto& [filter, reach] : {std::pair{ViewFilter::kGaussian3, 1}, {ViewFilter::kGaussian10, 10}}) {
        std::vector<double> expected(static_cast<std::size_t>(views), 0.0);
        double sum = 0.0;
        for (int i = -reach; i <= reach; ++i) {
          const double snapped = std::floor((g + static_cast<double>(i) / views) * views);
          if (snapped < 0 || snapped >= views) continue;  // the maker's would take a tile of another row
          const double off = g - snapped / views;
          expected[static_cast<std::size_t>(snapped)] = std::exp(-off * off / (2 * 0.01 * 0.01));
          sum += expected[static_cast<std::size_t>(snapped)];
        }
        for (const auto& [view, weight] : view_weights(g, views, filter))
          EXPECT_NEAR(weight, expected[static_cast<std::size_t>(view)] / sum, 1e-9) << views << " " << g << " " << view;
      }
    }
}

/// What the maker's weave for Unity (Lightfield.shader) multiplies a row's colours with; v up from the bottom.
double makers_fringe(double fringe, double v, double height) {
  const double pixel = v * height + std::ceil(fringe * 0.5);
  return 1.0 - std::abs(fringe) * std::floor(std::fmod(pixel, 2.0));
}

TEST(LensSheet, FringeDimsTheRowsThatTheMakersWeaveDims) {
  LookingGlassFigures f = portrait();
  for (const double fringe : {0.0, 0.2, -0.2, 1.0, -0.03}) {
    f.fringe = fringe;
    const LensSheet sheet = lens_sheet(f);
    for (int y = 0; y < 9; ++y)
      EXPECT_NEAR(row_light(sheet, y), makers_fringe(fringe, (y + 0.5) / f.screen_height, f.screen_height), 1e-9)
          << fringe << ", row " << y << " from the bottom";
  }
}

TEST(LensSheet, AWovenWhiteIsDimmedInEverySecondRow) {
  LookingGlassFigures f = portrait();
  f.screen_width = 8, f.screen_height = 4, f.fringe = 0.2;
  Image white(2, 2, 3);
  std::fill(white.pixels.begin(), white.pixels.end(), std::uint8_t{255});
  const Image woven = weave_views(std::vector<Image>(3, white), lens_sheet(f));
  for (int row = 0; row < 4; ++row)  // the bottom row is an even one
    EXPECT_EQ(woven.at(3, row)[1], row % 2 == 1 ? 204 : 255) << "row " << row << " from the top";
}

LensOptics laptop_lens() {
  LensOptics lens;
  lens.reduced_gap_mm = 0.9;
  lens.pitch_mm = 0.2;
  return lens;
}

TEST(LensOptics, RefractionIsSnellsLaw) {
  const LensOptics lens = laptop_lens();
  const glm::dvec3 eye{400.0, 0.0, 600.0};
  const double shift = refraction_shift_mm(lens, eye, {0.0, 0.0}).x;
  const double gap = lens.reduced_gap_mm * lens.refractive_index;  // d
  const double inside = std::atan(shift / gap);
  EXPECT_NEAR(lens.refractive_index * std::sin(inside), std::sin(std::atan2(400.0, 600.0)), 1e-12);
}

TEST(LensOptics, ParaxialShiftIsFortyTwoMicrometresOffFarFromTheAxis) {
  LensOptics lens = laptop_lens();
  lens.reduced_gap_mm = 0.9 / 1.5;
  const glm::dvec3 eye{400.0, 0.0, 600.0};
  const double error = paraxial_shift_mm(lens, eye, {0, 0}).x - refraction_shift_mm(lens, eye, {0, 0}).x;
  EXPECT_NEAR(error * 1000.0, 42.0, 0.5);
  EXPECT_NEAR(paraxial_shift_mm(lens, {1e-6, 0, 600}, {0, 0}).x / refraction_shift_mm(lens, {1e-6, 0, 600}, {0, 0}).x,
              1.0, 1e-12);
}

TEST(LensOptics, EyesAtTheDesignDistanceAreHalfAPeriodApart) {
  LensOptics lens = laptop_lens();
  lens.pitch_mm = 2.0 * lens.reduced_gap_mm * 63.0 / 600.0;
  const double left = eye_phase(lens, {-31.5, 0, 600}, {0, 0}), right = eye_phase(lens, {31.5, 0, 600}, {0, 0});
  EXPECT_NEAR(std::abs(right - left), 0.5, 1e-3);
}

}  // namespace
}  // namespace dubsar
