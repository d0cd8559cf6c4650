// Calibrations by every route, and the panel that "auto" stands for.

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "app/calibration/auto_panel.h"
#include "app/calibration/display_choice.h"
#include "core/base/files/atomic_file.h"
#include "devices/looking_glass/bridge_client.h"
#include "devices/looking_glass/looking_glass_sim.h"
#include "tests/devices/fake_bridge.h"
#include "tests/display/panels/made_edid.h"
#include "tests/display/spec.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

std::string calibration(std::string_view serial, int width, int height, double pitch = 52.5) {
  return fmt::format(
      R"({{"configVersion": "3.0", "serial": "{}", "pitch": {{"value": {}}}, "slope": {{"value": -7.2}}, "center": {{"value": 0.4}},
                         "viewCone": {{"value": 40}}, "invView": {{"value": 1}}, "DPI": {{"value": 324}}, "screenW": {{"value": {}}}, "screenH": {{"value": {}}}}})",
      serial, pitch, width, height);
}
const std::string kPortrait = calibration("LKG-P00671", 1536, 2048),
                  kLarge = calibration("LKG-4K-00017", 3840, 2160, 50.1);

class Panels : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "media/LKG-P/LKG_calibration"); }
  void TearDown() override { fs::remove_all(folder_); }
  void store(const std::string& text) {
    ASSERT_TRUE(write_file_atomically(folder_ / "media/LKG-P/LKG_calibration/visual.json", text));
    search_.mounts = {folder_ / "media"};
  }
  void plug_in(const std::string& text, LookingGlassManners manners) {
    units_.push_back(std::make_unique<LookingGlassSim>(text, manners));
    search_.hid.push_back(
        {"/dev/hidraw9",
         [unit = units_.back().get()]() -> Result<std::unique_ptr<Transport>> { return unit->device().open(); },
         {}});
  }
  void ask(const test::FakeBridge& bridge) {
    search_.bridge = bridge_opener(bridge.port());
    search_.bridge_place = "bridge";
  }
  CalibrationReport find() { return find_calibrations(search_, panels_, SteadyClock()); }
  Result<PanelProfile> choose(const std::vector<ConnectedEdid>& edids = {}) {
    return choose_auto_panel({find(), edids}, panels_);
  }
  static ConnectedEdid monitor(const test::MadeEdid& of) {
    const std::string bytes = test::made_edid(of);
    return {"DP-1", parse_edid(std::as_bytes(std::span(bytes.data(), bytes.size())))};
  }

  fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_panels_{}", ::getpid());
  const PanelSet& panels_ = built_in_panels();
  std::vector<std::unique_ptr<LookingGlassSim>> units_;
  CalibrationSearch search_;
};

TEST_F(Panels, EveryRouteGivesTheSameFigures) {
  store(kPortrait);
  plug_in(kPortrait, {.split = true, .stale_pages = 2});
  const test::FakeBridge bridge({{"LKG-P00671", "portrait", kPortrait}, {"DELL", "thirdparty", ""}});
  ask(bridge);
  search_.file = folder_ / "media/LKG-P/LKG_calibration/visual.json";
  const CalibrationReport report = find();
  EXPECT_TRUE(report.missing.empty());
  ASSERT_EQ(report.found.size(), 4u);
  const char* routes[] = {"file", "usb_storage", "usb_hid", "bridge"};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(report.found[i].route, routes[i]);
    EXPECT_EQ(report.found[i].serial, "LKG-P00671");
    ASSERT_TRUE(report.found[i].panel) << report.found[i].problem;
    EXPECT_EQ(report.found[i].panel->name, "looking-glass-portrait");
    EXPECT_EQ(report.found[i].panel->sheet->pitch, 52.5);
  }
}

TEST_F(Panels, RoutesThatGiveNothingSayWhy) {
  search_.mounts = {folder_ / "nowhere"};
  search_.bridge = [] { return Result<std::unique_ptr<Transport>>(fail(ErrorKind::kUnavailable, "cannot connect")); };
  search_.hid.push_back({"/dev/hidraw3", {}, "this user may not open it; copy the udev rule"});
  const CalibrationReport report = find();
  EXPECT_TRUE(report.found.empty());
  ASSERT_EQ(report.missing.size(), 3u);
  EXPECT_NE(report.missing[0].second.find("nowhere/*/LKG_calibration/visual.json"), std::string::npos);
  EXPECT_NE(report.missing[1].second.find("udev rule"), std::string::npos);
  EXPECT_NE(report.missing[2].second.find("cannot connect"), std::string::npos);
  const auto chosen = choose();
  EXPECT_EQ(chosen.error().kind, ErrorKind::kUnavailable);
  EXPECT_NE(chosen.error().message.find("udev rule"), std::string::npos);
}

TEST_F(Panels, BadCalibrationsAreRefusedByNameAndRangeWhateverTheRoute) {
  const std::string bad = calibration("LKG-P00671", 1536, 2048, 0.001);
  store(bad);
  plug_in(bad, {});
  plug_in("", {.blank = true});
  const test::FakeBridge bridge({{"LKG-P00671", "portrait", bad}});
  ask(bridge);
  const CalibrationReport report = find();
  ASSERT_EQ(report.found.size(), 4u);
  for (const std::size_t i : {0u, 1u, 3u}) {
    EXPECT_FALSE(report.found[i].panel);
    EXPECT_NE(report.found[i].problem.find("pitch is 0.001, expected 5 to 500"), std::string::npos)
        << report.found[i].problem;
  }
  EXPECT_NE(report.found[2].problem.find("blank"), std::string::npos);
}

TEST_F(Panels, AutoTakesTheOneUnitHoweverManyRoutesItHas) {
  store(kPortrait);
  const test::FakeBridge bridge({{"LKG-P00671", "portrait", kPortrait}});
  ask(bridge);
  const PanelProfile panel = choose().value();
  EXPECT_EQ(panel.name, "looking-glass-portrait");
  EXPECT_EQ(panel.sheet->pitch, 52.5);
  EXPECT_EQ(panel.lenses.calibration, (folder_ / "media/LKG-P/LKG_calibration/visual.json").string());
}

TEST_F(Panels, SinksTakeACalibrationThatIsNoFile) {
  plug_in(kLarge, {});
  SinkCatalog catalog;
  const auto size = catalog.panels().profiles.size();
  catalog.put(choose().value());
  EXPECT_EQ(catalog.panels().profiles.size(), size);
  EXPECT_EQ(catalog.panels().find("looking-glass-15.6")->sheet->pitch, 50.1);
  for (const char* text : {"quilt:auto", "lenticular:auto,nearest", "lenticular:nearest,panel=auto"}) {
    const SinkSpec display = testing::spec(text);
    ASSERT_TRUE(names_auto_panel(display)) << text;
    const SinkSpec named = with_panel(display, choose().value());
    EXPECT_NE(named.text().find("panel=looking-glass-15.6"), std::string::npos) << named.text();
    const auto sink = catalog.make(named);
    EXPECT_TRUE(sink) << sink.error().message;
  }
}

TEST_F(Panels, AutoAmongSeveralUnitsGoesByTheMonitorsNameElseAsks) {
  store(kPortrait);
  plug_in(kLarge, {});
  const auto unclear = choose();
  EXPECT_EQ(unclear.error().kind, ErrorKind::kUsage);
  EXPECT_NE(unclear.error().message.find("looking-glass-15.6"), std::string::npos);
  const auto shown =
      monitor({.width_px = 1536, .height_px = 2048, .width_mm = 120, .height_mm = 160, .name = "LKG-P00671"});
  EXPECT_EQ(choose({shown})->name, "looking-glass-portrait");
}

TEST_F(Panels, AutoKnowsTrackedPanelsByTheirEdid) {
  EXPECT_EQ(choose({monitor({.manufacturer = "ACR", .product = 1})})->name, "spatiallabs-15.6");
  const auto bare =
      choose({monitor({.width_px = 1536, .height_px = 2048, .width_mm = 120, .height_mm = 160, .name = "LKG-P00671"})});
  EXPECT_NE(bare.error().message.find("LKG-P00671 at DP-1"), std::string::npos);
  store(kPortrait);
  EXPECT_EQ(choose({monitor({.manufacturer = "ACR", .product = 1})}).error().kind, ErrorKind::kUsage);
}

TEST_F(Panels, DisplaysWithoutAutoAreLeftAlone) {
  for (const char* text : {"anaglyph", "lenticular:looking-glass-go,nearest"}) {
    EXPECT_FALSE(names_auto_panel(testing::spec(text)));
    EXPECT_EQ(choose_display(text, {}, 0)->display, testing::spec(text));
  }
}

}  // namespace
}  // namespace dubsar::app
