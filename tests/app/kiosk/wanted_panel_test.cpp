#include "app/kiosk/wanted_panel.h"

#include <gtest/gtest.h>

namespace dubsar::app {
namespace {

Monitor monitor(std::string name, int width, int height, bool primary = false) {
  Monitor out;
  out.name = std::move(name);
  out.width_px = width;
  out.height_px = height;
  out.primary = primary;
  return out;
}

SinkTraits lenses(int width, int height) {
  return {.name = "lenticular", .views = 48, .output = {width, height}, .own_pixels = true, .exact_pixels = true};
}

TEST(WantedPanel, IsTheNamedOneWithThePixelsOfTheDisplay) {
  const std::vector<Monitor> two{monitor("DELL U2720Q", 3840, 2160, true), monitor("LKG 1", 1536, 2048),
                                 monitor("LKG 2", 1440, 2560)};
  const auto portrait = choose_panel(two, "LKG", lenses(1536, 2048)), go = choose_panel(two, "LKG", lenses(1440, 2560)),
             unnamed = choose_panel(two, "", lenses(1440, 2560)), flat = choose_panel(two, "", SinkTraits());
  EXPECT_EQ(portrait.monitor, "LKG 1");
  EXPECT_EQ(go.monitor, "LKG 2");
  EXPECT_EQ(unnamed.monitor, "LKG 2");
  EXPECT_EQ(flat.monitor, "DELL U2720Q");
  for (const auto& choice : {portrait, go, unnamed, flat}) {
    EXPECT_FALSE(choice.flat);
    EXPECT_EQ(choice.trouble, "");
  }
}

TEST(WantedPanel, ThatIsAwayIsReplacedByAnyAndSaid) {
  const std::vector<Monitor> one{monitor("screen", 1920, 1080, true)};
  const auto away = choose_panel(one, "HDMI-1", SinkTraits());
  EXPECT_EQ(away.monitor, "");
  EXPECT_FALSE(away.flat) << "a flat picture is what was wanted";
  EXPECT_EQ(away.trouble, "no monitor's name contains \"HDMI-1\", there are: screen; it is looked for every 2 s");
  const auto lens = choose_panel(one, "HDMI-1", lenses(1440, 2560));
  EXPECT_TRUE(lens.flat);
  EXPECT_EQ(lens.trouble,
            away.trouble +
                "; display lenticular makes pictures of 1440 x 2560 pixels and monitor \"screen\" has 1920 x "
                "1080: this one is flat");
  EXPECT_FALSE(choose_panel({}, "HDMI-1", lenses(1440, 2560)).trouble.empty());
}

TEST(WantedPanel, WithOtherPixelsThanTheDisplayIsFlatAndSaid) {
  const std::vector<Monitor> one{monitor("HDMI-1", 1920, 1080, true)};
  const auto wrong = choose_panel(one, "HDMI-1", lenses(1440, 2560));
  EXPECT_EQ(wrong.monitor, "HDMI-1");
  EXPECT_TRUE(wrong.flat);
  EXPECT_NE(wrong.trouble, "");
}

TEST(MonitorWatch, SeesTheWantedOneComeAndGoAndNoOther) {
  constexpr TimestampNs kSecond = 1'000'000'000;
  std::vector<Monitor> there{monitor("screen", 1920, 1080, true)};
  int asked = 0;
  MonitorWatch watch("LKG", [&]() -> Result<std::vector<Monitor>> {
    ++asked;
    return there;
  });
  ASSERT_TRUE(watch.look());
  EXPECT_FALSE(watch.changed(0));
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(watch.changed(i * kSecond / 60));
  EXPECT_EQ(asked, 2) << "every 2 s";
  there.push_back(monitor("LKG 1", 1536, 2048));
  EXPECT_TRUE(watch.changed(3 * kSecond));
  ASSERT_TRUE(watch.look());
  there.push_back(monitor("DP-2", 800, 600));
  EXPECT_FALSE(watch.changed(6 * kSecond)) << "another panel's";
  there = {there[0]};
  EXPECT_TRUE(watch.changed(9 * kSecond));
  ASSERT_TRUE(watch.look());
  there[0].width_px = 1280;
  EXPECT_TRUE(watch.changed(12 * kSecond)) << "it is what the picture is on meanwhile";
  ASSERT_TRUE(watch.look());
  const std::vector<Monitor> before = std::exchange(there, {});
  EXPECT_FALSE(watch.changed(15 * kSecond)) << "there is nowhere to go";
  there = before;
  EXPECT_TRUE(watch.changed(18 * kSecond)) << "the window has to cover it again";
  MonitorWatch deaf("LKG", []() -> Result<std::vector<Monitor>> { return fail(ErrorKind::kUnavailable, "gone"); });
  EXPECT_FALSE(deaf.look());
  EXPECT_FALSE(deaf.changed(kSecond));
}

}  // namespace
}  // namespace dubsar::app
