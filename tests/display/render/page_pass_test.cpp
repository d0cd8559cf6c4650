// A page in the world: where each view sees it, and how much shines through.

#include "display/render/passes/page_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "display/optics/off_axis.h"
#include "display/render/context/context_egl.h"

namespace dubsar {
namespace {

constexpr int kPx = 200;

Image plain(int side, std::array<std::uint8_t, 4> color) {
  Image out(side, side, 4);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) std::copy_n(color.data(), 4, out.at(x, y));
  return out;
}

/// Pixels of a row or column of the picture where the page is seen.
std::pair<int, int> run_of(const Image& image, bool across, int at) {
  int first = -1, last = -1;
  for (int i = 0; i < kPx; ++i)
    if ((across ? image.at(i, at) : image.at(at, i))[0] > 128) {
      if (first < 0) first = i;
      last = i;
    }
  return {first, last};
}

TEST(PagePass, EachEyeSeesThePageWhereItStands) {
  const auto context = EglContext::create().value();
  auto pass = PagePass::create().value();
  auto page = ViewArray::create(8, 8, 1).value();
  ASSERT_TRUE(page.write_layer(0, plain(8, {255, 255, 255, 255})));
  auto target = ViewArray::create(kPx, kPx, 2).value();
  // A window of 200 mm before eyes 600 mm away; the page stands as far behind it, 80 mm wide and 40 mm high.
  const WindowRect window{{-100, -100, 0}, {100, -100, 0}, {-100, 100, 0}};
  Observer viewer;
  viewer.left_mm = {-60, 0, 600};
  viewer.right_mm = {60, 0, 600};
  viewer.back_mm = -2000;
  const std::array<View, 2> views{viewer_view(window, viewer, viewer.left_mm),
                                  viewer_view(window, viewer, viewer.right_mm)};
  for (int layer = 0; layer < 2; ++layer) ASSERT_TRUE(target.write_layer(layer, plain(kPx, {0, 0, 0, 255})));
  ASSERT_TRUE(pass.draw(page, {{-40, 0, -600}, {80, 0, 0}, {0, 40, 0}}, views, target));
  for (int eye = 0; eye < 2; ++eye) {
    // Half way to the page the lines of sight meet the window: the page's half size, moved by half of the eye's place.
    const double middle = 100.0 + (eye == 0 ? -30.0 : 30.0);
    const Image seen = target.read_layer(eye).value();
    const auto [left, right] = run_of(seen, true, kPx / 2 - 10);  // 10 mm above the middle; row 0 is the top
    EXPECT_NEAR(left, middle - 20.0, 1.0) << eye;
    EXPECT_NEAR(right + 1, middle + 20.0, 1.0) << eye;
    const auto [top, bottom] = run_of(seen, false, static_cast<int>(middle));
    EXPECT_NEAR(top, 80.0, 1.0) << eye;
    EXPECT_NEAR(bottom + 1, 100.0, 1.0) << eye;
  }
}

TEST(PagePass, WhatIsHalfTransparentShinesThrough) {
  const auto context = EglContext::create().value();
  auto pass = PagePass::create().value();
  auto page = ViewArray::create(8, 8, 1).value();
  auto target = ViewArray::create(kPx, kPx, 1).value();
  const WindowRect window{{-100, -100, 0}, {100, -100, 0}, {-100, 100, 0}};
  Observer viewer;
  const std::array<View, 1> views{viewer_view(window, viewer, {0, 0, 600})};
  const PagePlace whole{{-100, -100, 0}, {200, 0, 0}, {0, 200, 0}};
  ASSERT_TRUE(target.write_layer(0, plain(kPx, {200, 100, 0, 255})));
  ASSERT_TRUE(page.write_layer(0, plain(8, {0, 0, 0, 0})));
  ASSERT_TRUE(pass.draw(page, whole, views, target));
  EXPECT_EQ(target.read_layer(0)->at(50, 50)[0], 200) << "an empty page hides nothing";
  ASSERT_TRUE(page.write_layer(0, plain(8, {0, 0, 128, 128})));
  ASSERT_TRUE(pass.draw(page, whole, views, target));
  const Image seen = target.read_layer(0).value();
  EXPECT_NEAR(seen.at(50, 50)[0], 100, 1);
  EXPECT_NEAR(seen.at(50, 50)[1], 50, 1);
  EXPECT_NEAR(seen.at(50, 50)[2], 128, 1);
}

}  // namespace
}  // namespace dubsar
