// The sample plug-in, built as its own project, does what it says; broken ones are refused by name.

#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "display/render/images/test_pattern.h"
#include "display/sinks/catalog/plugin_sink.h"
#include "display/sinks/render_display.h"
#include "display/sinks/sink_window.h"
#include "tests/display/spec.h"
#include "tests/display/xvfb_server.h"

namespace dubsar {
namespace {

std::filesystem::path broken(int how) { return fmt::format("{}/libbroken_plugin_{}.so", DUBSAR_BROKEN_PLUGINS, how); }

std::shared_ptr<SinkCatalog> with(std::vector<std::shared_ptr<SinkPlugin>> plugins) {
  return std::make_shared<SinkCatalog>(built_in_panels(), std::move(plugins));
}

DisplayOptions small_screen() {
  DisplayOptions options;
  options.screen = {
      .width_mm = 160, .height_mm = 90, .width_px = 160, .height_px = 90, .window_w = 160, .window_h = 90};
  return options;
}

TEST(Plugin, TheSampleMirrorsTheMonoPicture) {
  const auto plugin = SinkPlugin::load(DUBSAR_SAMPLE_PLUGIN);
  ASSERT_TRUE(plugin) << plugin.error().message;
  EXPECT_EQ((*plugin)->name(), "mirrored");
  DisplayOptions options = small_screen();
  options.catalog = with({*plugin});
  const Image mono = render_pattern({"mono"}, options)->image;
  for (const bool upside_down : {false, true}) {
    const auto mirrored = render_pattern(testing::spec(upside_down ? "mirrored:upside_down" : "mirrored"), options);
    ASSERT_TRUE(mirrored) << mirrored.error().message;
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 160; ++x)
        for (int c = 0; c < 3; ++c)
          ASSERT_EQ(mirrored->image.at(x, y)[c], mono.at(upside_down ? x : 159 - x, upside_down ? 89 - y : y)[c])
              << x << ", " << y;
  }
}

TEST(Plugin, ItsViewIsThatOfTheMirroredViewer) {
  const auto plugin = SinkPlugin::load(DUBSAR_SAMPLE_PLUGIN).value();
  const auto sink = plugin->create("").value(), mono = SinkCatalog().make("mono").value();
  const Screen screen = small_screen().screen;
  ASSERT_TRUE(sink->configure(screen) && mono->configure(screen));
  Observer viewer;
  viewer.left_mm = {40, 20, 500};
  viewer.right_mm = {100, 20, 520};
  const View made = sink->views(viewer)[0];
  viewer.left_mm.x *= -1;
  viewer.right_mm.x *= -1;
  viewer.nominal_mm = viewer.centre_mm();
  EXPECT_EQ(made.clip_from_world(), mono->views(viewer)[0].clip_from_world());
}

TEST(Plugin, OptionsItDoesNotKnowAreItsOwnSentence) {
  const auto plugin = SinkPlugin::load(DUBSAR_SAMPLE_PLUGIN).value();
  const auto sink = plugin->create("sideways");
  ASSERT_FALSE(sink);
  EXPECT_EQ(sink.error().kind, ErrorKind::kUsage);
  EXPECT_NE(sink.error().message.find("\"sideways\" is not known"), std::string::npos) << sink.error().message;
}

TEST(Plugin, ASampleOpensInAWindow) {
  const testing::XvfbServer server;
  if (!server.problem().empty()) GTEST_SKIP() << server.problem();
  WindowOptions window;
  window.width = 64;
  window.height = 48;
  EXPECT_EQ(open_sink_window({}, {"mirrored"}, window).error().kind, ErrorKind::kUsage);
  const auto plugins = load_plugins({DUBSAR_SAMPLE_PLUGIN}).value();
  const auto shown = open_sink_window(*with(plugins), {"mirrored"}, window);
  ASSERT_TRUE(shown) << shown.error().message;
  EXPECT_EQ(shown->sink->traits().name, "mirrored");
  EXPECT_EQ(shown->sink->traits().output, (PixelSize{64, 48}));
  EXPECT_EQ(load_plugins({DUBSAR_SAMPLE_PLUGIN, "/nowhere.so"}).error().kind, ErrorKind::kNoInput);
}

TEST(Plugin, TablesThatDoNotFitAreRefusedWithWhatWasFound) {
  constexpr std::array<const char*, 6> kWords{"ABI version 2 found, expected 1",
                                              "its table has 16 bytes",
                                              "gaps",
                                              "built-in display",
                                              "\"No Name\"",
                                              "refuses to work"};
  for (std::size_t how = 0; how < kWords.size(); ++how) {
    const auto plugin = SinkPlugin::load(broken(static_cast<int>(how) + 1));
    ASSERT_FALSE(plugin) << kWords[how];
    EXPECT_EQ(plugin.error().kind, ErrorKind::kBadData);
    EXPECT_NE(plugin.error().message.find(kWords[how]), std::string::npos) << plugin.error().message;
  }
  EXPECT_EQ(SinkPlugin::load("/nowhere.so").error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(SinkPlugin::load("/etc/passwd").error().kind, ErrorKind::kUnavailable);
}

TEST(Plugin, ImpossibleWishesAndViewsAreRefused) {
  for (const int how : {7, 8}) {
    DisplayOptions options = small_screen();
    options.catalog = with({SinkPlugin::load(broken(how)).value()});
    const auto picture = render_pattern({"broken"}, options);
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error().kind, ErrorKind::kBadData) << picture.error().message;
  }
}

TEST(Plugin, UnknownDisplaysAreStillUsageErrors) {
  DisplayOptions options = small_screen();
  options.catalog = with({SinkPlugin::load(DUBSAR_SAMPLE_PLUGIN).value()});
  EXPECT_EQ(render_pattern({"hologram"}, options).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
