#include "display/optics/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>

#include "display/optics/srgb.h"
#include "tests/display/reference_pictures.h"

namespace dubsar {
namespace {
using testing::weave_tracked;
using testing::weave_views;

/// A 15.6" 4K panel: 6.7 subpixels a lens, slant atan(1/3), made for eyes 63 mm apart at 600 mm.
TrackedPanel laptop() {
  TrackedPanel panel;
  panel.width_px = 3840;
  panel.height_px = 2160;
  LensOptics& lens = panel.lens;
  lens.pixel_mm = glm::dvec2(345.4 / 3840.0);
  lens.pitch_mm = 6.7 * lens.pixel_mm.x / 3.0;
  lens.tan_slant = 1.0 / 3.0;
  lens.reduced_gap_mm = lens.pitch_mm * 600.0 / (2.0 * 63.0);
  lens.spot_sigma_periods = 0.1;
  lens.phase0 = 0.2;
  return panel;
}

EyePair eyes_at(double x, double y, double z) { return {{x - 31.5, y, z}, {x + 31.5, y, z}}; }

TEST(Visibility, IsLargestInFrontAndZeroHalfAPeriodAwayForASharpLens) {
  LensOptics lens = laptop().lens;
  lens.spot_sigma_periods = 0.0;
  EXPECT_GT(visibility(lens, 0.0), visibility(lens, 0.1));
  EXPECT_DOUBLE_EQ(visibility(lens, 0.5), 0.0);
  EXPECT_NEAR(visibility(lens, 0.13), visibility(lens, -0.13), 1e-12);
}

TEST(Visibility, IntegratesToTheSpotAreaWhateverTheBlur) {
  double reference = 0.0;
  for (const double sigma : {0.01, 0.05, 0.1}) {
    LensOptics lens = laptop().lens;
    lens.spot_sigma_periods = sigma;
    double sum = 0.0;
    for (int i = 0; i < 1000; ++i) sum += visibility(lens, (i + 0.5) / 1000.0 - 0.5);
    if (reference == 0.0) reference = sum;
    EXPECT_NEAR(sum, reference, 1e-3 * reference);
  }
}

TEST(TrackedWeave, WrongEyeLightIsAtMostFourPercentAtTheDesignDistance) {
  const EyePair eyes = eyes_at(0, 0, 600);
  EXPECT_LE(wrong_eye_light(laptop(), eyes, eyes).worst(), 0.04);
}

TEST(TrackedWeave, WrongEyeLightStaysBelowFivePercentAnywhereSidewaysWhenWovenForTheTrueEye) {
  for (double x = -63.0; x <= 63.0; x += 10.5) {
    const EyePair eyes = eyes_at(x, 0, 600);
    EXPECT_LE(wrong_eye_light(laptop(), eyes, eyes, true, 32).worst(), 0.05) << "x = " << x;
  }
}

TEST(TrackedWeave, AStaleWeaveGetsWorseWithTheHeadsMoveUntilItIsPseudoscopic) {
  double before = 0.0;
  for (const double moved : {0.0, 8.0, 15.0, 31.0, 63.0}) {
    const double light = wrong_eye_light(laptop(), eyes_at(0, 0, 600), eyes_at(moved, 0, 600), true, 32).worst();
    EXPECT_GT(light, before) << moved;
    before = light;
  }
}

TEST(TrackedWeave, ExactRefractionBeatsParaxialOffTheAxis) {
  const EyePair eyes = eyes_at(120, 60, 500);
  const double exact = wrong_eye_light(laptop(), eyes, eyes, true, 32).worst();
  const double paraxial = wrong_eye_light(laptop(), eyes, eyes, false, 32).worst();
  EXPECT_LT(exact, 0.05);
  EXPECT_GT(paraxial, 2.5 * exact);
}

/// The figures of an independent simulation of the same panel (design note: displays, section 2.2), in percent.
TEST(TrackedWeave, TheSimulatorAgreesWithPublishedFigures) {
  const auto percent = [](const glm::dvec3& woven, const glm::dvec3& true_head, bool exact) {
    return 100 * wrong_eye_light(laptop(), eyes_at(woven.x, woven.y, woven.z),
                                 eyes_at(true_head.x, true_head.y, true_head.z), exact, 64)
                     .worst();
  };
  const glm::dvec3 front(0, 0, 600), aside(120, 60, 500);
  EXPECT_NEAR(percent(front, front, true), 3.8, 0.6);
  EXPECT_NEAR(percent(front, {8, 0, 600}, true), 6.5, 0.6);
  EXPECT_NEAR(percent(front, {15, 0, 600}, true), 13.0, 1.1);
  EXPECT_NEAR(percent(front, {31, 0, 600}, true), 50.0, 2.0);
  EXPECT_NEAR(percent(front, {63, 0, 600}, true), 96.0, 1.0);
  EXPECT_NEAR(percent({0, 0, 450}, {0, 0, 450}, true), 7.0, 1.0);
  EXPECT_NEAR(percent({0, 0, 800}, {0, 0, 800}, true), 7.0, 1.0);
  EXPECT_NEAR(percent(aside, aside, true), 4.5, 0.6);
  EXPECT_NEAR(percent(aside, aside, false), 12.6, 0.8);
}

TEST(TrackedWeave, EachEyeSeesItsOwnColour) {
  TrackedPanel panel = laptop();
  panel.width_px = 384;
  panel.height_px = 216;
  Image left(4, 4, 3), right(4, 4, 3);
  for (int i = 0; i < 16; ++i) left.pixels[i * 3] = 200, right.pixels[i * 3 + 1] = 100;
  const EyePair eyes = eyes_at(20, -10, 620);
  const Image woven = weave_tracked(left, right, panel, eyes);
  const Image by_left = see(woven, panel, eyes.left_mm), by_right = see(woven, panel, eyes.right_mm);
  const auto mean = [](const Image& image, int channel) {
    double sum = 0.0;
    for (int x = 92; x < 292; ++x) sum += linear_from_srgb(image.at(x, 108)[channel]) / 200.0;
    return sum;
  };
  const double red = linear_from_srgb(200), green = linear_from_srgb(100);
  EXPECT_GT(mean(by_left, 0), 0.94 * red);    // at least 94 % of the left image's red light,
  EXPECT_LT(mean(by_left, 1), 0.06 * green);  // at most 6 % of the right image's green
  EXPECT_LT(mean(by_right, 0), 0.06 * red);
  EXPECT_GT(mean(by_right, 1), 0.94 * green);
}

TEST(ViewSheet, AnEyeFurtherRightSeesAHigherView) {
  LookingGlassFigures f;
  f.pitch = 52.594383, f.slope = -7.211529, f.dpi = 324.0, f.screen_width = 1536, f.screen_height = 2048,
  f.center = 0.3;
  const LensSheet sheet = lens_sheet(f);
  const double cone = 40.0 * std::numbers::pi / 180.0, distance = 914.4;
  const TrackedPanel panel = optics_of_sheet(sheet, 1536 / 324.0 * 25.4, cone, distance);
  for (const double degrees : {-15.0, -5.0, 0.0, 5.0, 15.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const auto shares = view_shares(sheet, panel, 48, {distance * std::tan(angle), 0.0, distance}, 64);
    double mean = 0.0;
    for (int view = 0; view < 48; ++view) mean += (view + 0.5) * shares[static_cast<std::size_t>(view)];
    EXPECT_NEAR(mean, 24.0 + 24.0 * std::tan(angle) / std::tan(0.5 * cone), 1.6) << degrees;
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-9);
  }
}

TEST(ViewSheet, ViewKPaintedWithColourKArrivesInItsDirection) {
  LookingGlassFigures f;
  f.pitch = 52.594383, f.slope = -7.211529, f.dpi = 324.0, f.screen_width = 768, f.screen_height = 256;
  const LensSheet sheet = lens_sheet(f);
  const double cone = 40.0 * std::numbers::pi / 180.0, distance = 914.4;
  const TrackedPanel panel = optics_of_sheet(sheet, 768 / 324.0 * 25.4, cone, distance);
  std::vector<Image> views;
  for (int k = 0; k < 48; ++k) {
    views.emplace_back(2, 2, 3);
    for (auto& value : views.back().pixels) value = static_cast<std::uint8_t>(5 * k);
  }
  const Image woven = weave_views(views, sheet, {ViewFilter::kNearest, 0.01});
  for (const int k : {8, 20, 24, 33, 40}) {
    const double angle = std::atan(((k + 0.5) / 24.0 - 1.0) * std::tan(0.5 * cone));
    const Image seen = see(woven, panel, {distance * std::tan(angle), 0.0, distance});
    double mean = 0.0;
    for (int x = 300; x < 468; ++x) mean += seen.at(x, 128)[1] / 168.0;
    EXPECT_NEAR(mean / 5.0, k, 1.5);
  }
}

}  // namespace
}  // namespace dubsar
