// Displays from the command line: panels, patterns, what an eye sees, adjustments.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "core/base/files/atomic_file.h"
#include "core/image_io/picture_file.h"
#include "core/image_io/png_file.h"
#include "tests/app/cli/run_program.h"
#include "tests/devices/fake_bridge.h"
#include "tests/display/panels/made_edid.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

class DisplaysCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_displays_{}", ::getpid());
    fs::create_directories(folder_);
    ::setenv("XDG_CONFIG_HOME", (folder_ / "config").c_str(), 1);
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
    ASSERT_TRUE(
        write_file_atomically(folder_ / "card.obj", "v 0 0 0\nv 40 0 0\nv 40 20 0\nv 0 20 4\nf 1 2 3\nf 1 3 4\n"));
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  static std::string file(const char* name) { return (folder_ / name).string(); }
  static nlohmann::json json(std::vector<std::string> arguments, int exit_code = 0) {
    arguments.insert(arguments.end(), {"--json", "-", "--quiet"});
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    return nlohmann::json::parse(run.out, nullptr, false);
  }
  inline static fs::path folder_;
};

TEST_F(DisplaysCommand, ListsWhatThereIsAndWhyMonitorsAreMissing) {
  const auto found = json({"displays", "--bridge-port", "0"});
  ASSERT_TRUE(found.is_object());
  EXPECT_EQ(found["displays"][0]["name"], "mono");
  const auto panel = [&](const char* name) {
    for (const auto& entry : found["panels"])
      if (entry["name"] == name) return entry;
    return nlohmann::json();
  };
  EXPECT_EQ(panel("looking-glass-go")["views"], 66);
  EXPECT_EQ(panel("looking-glass-65")["lens_figures"], false);
  EXPECT_EQ(panel("sr-32")["kind"], "tracked");
  EXPECT_EQ(found["monitors"].size(), 0u);
  EXPECT_NE(found["monitors_missing"].get<std::string>().find("DISPLAY"), std::string::npos);
  for (const char* route : {"usb_storage", "usb_hid"})
    EXPECT_TRUE(found["calibrations_missing"][route].is_string()) << route;
}

TEST_F(DisplaysCommand, ACalibrationFromTheMakersServiceServesThePanelCalledAuto) {
  ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
  const std::string text =
      R"({"serial": "LKG-E42", "pitch": 80.1, "slope": -6.6, "DPI": 491, "screenW": 1440, "screenH": 2560})";
  const FakeBridge bridge({{"LKG-E42", "go_p", text}});
  const std::string port = std::to_string(bridge.port());
  const auto found = json({"displays", "--bridge-port", port})["calibrations"];
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["route"], "bridge");
  EXPECT_EQ(found[0]["panel"], "looking-glass-go");
  const auto made = json({"render", file("card.obj"), "-o", file("auto.png"), "--display", "quilt:auto",
                          "--bridge-port", port, "--samples", "1"});
  EXPECT_EQ(made["display"], "quilt:panel=looking-glass-go");
  EXPECT_FALSE(fs::exists(folder_ / "cache" / "dubsar")) << "nothing is kept";
  EXPECT_EQ(
      run_dubsar({"render", "--pattern", "-o", file("none.png"), "--display", "lenticular:auto", "--bridge-port", "0"})
          .exit_code,
      69);
}

TEST_F(DisplaysCommand, ConnectedPanelsAreNamedByTheirEdid) {
  fs::create_directories(folder_ / "drm/card0-DP-2");
  ASSERT_TRUE(write_file_atomically(folder_ / "drm/card0-DP-2/edid",
                                    made_edid({.manufacturer = "ACR", .product = 1, .name = "ASV15-1B"})));
  const auto found = json({"displays", "--edids", file("drm"), "--bridge-port", "0"})["edids"];
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["connector"], "DP-2");
  EXPECT_EQ(found[0]["panels"][0], "spatiallabs-15.6");
}

TEST_F(DisplaysCommand, CrosstalkOfATrackedPanelIsToldAgainstSpeedAndLatency) {
  const auto curve = json({"displays", "--crosstalk", "spatiallabs-15.6"});
  EXPECT_LE(curve["nominal_percent"].get<double>(), 4.0);
  EXPECT_LE(curve["worst_sideways_percent"].get<double>(), 5.0);
  double of_8_mm = 0;
  for (const auto& lag : curve["lags"])
    if (lag["head_mm_s"] == 200 && lag["latency_ms"] == 40) of_8_mm = lag["percent"];
  EXPECT_NEAR(of_8_mm, 6.5, 0.6);
  EXPECT_EQ(run_dubsar({"displays", "--crosstalk", "looking-glass-go"}).exit_code, 78);
}

TEST_F(DisplaysCommand, CalibrationFilesAreReadAndProblemsNamed) {
  ASSERT_TRUE(write_file_atomically(
      file("visual.json"),
      R"({"serial": "LKG-E77", "pitch": 80.1, "slope": -6.6, "DPI": 491, "screenW": 1440, "screenH": 2560})"));
  EXPECT_EQ(json({"displays", "--calibration", file("visual.json")})["calibrations"][0]["panel"], "looking-glass-go");
  ASSERT_TRUE(write_file_atomically(file("bad.json"), R"({"pitch": 80.1, "slope": 0})"));
  EXPECT_EQ(run_dubsar({"displays", "--calibration", file("nowhere.json")}).exit_code, 66);
  const auto bad = json({"displays", "--calibration", file("bad.json")}, 78)["calibrations"][0];
  EXPECT_NE(bad["problem"].get<std::string>().find("slope is 0"), std::string::npos) << bad;
  for (const char* text : {"{\"pitch\": ", "", "[]", "\x89PNG", "{\"pitch\": {\"value\": \"52\"}}"}) {
    ASSERT_TRUE(write_file_atomically(file("bad.json"), text));
    const ProgramRun told = run_dubsar({"displays", "--calibration", file("bad.json"), "-q"});
    EXPECT_EQ(told.exit_code, 78) << text;
    EXPECT_TRUE(told.err.starts_with("error: --calibration ")) << told.err;
    EXPECT_EQ(told.out, "");
    EXPECT_EQ(run_dubsar({"render", "--pattern", "-o", file("p.png"), "--display",
                          "lenticular:calibration=" + file("bad.json")})
                  .exit_code,
              78)
        << text;
  }
}

TEST_F(DisplaysCommand, AnAdjustmentChangesThePictureUntilItIsReset) {
  const std::vector<std::string> render{"render",      "--pattern", "-o",
                                        file("p.png"), "--display", "lenticular:lens-sheet-24-5-views"};
  const auto pixels = [&] {
    EXPECT_EQ(run_dubsar(render).exit_code, 0);
    return read_png(file("p.png"))->pixels;
  };
  const auto before = pixels();
  const auto saved = json({"displays", "--adjust", "lens-sheet-24-5-views", "center=0.5"});
  EXPECT_TRUE(fs::exists(saved["file"].get<std::string>()));
  EXPECT_NE(pixels(), before);
  EXPECT_EQ(json({"displays", "--adjust", "lens-sheet-24-5-views", "reset"})["removed"], true);
  EXPECT_EQ(pixels(), before);
  EXPECT_EQ(run_dubsar({"displays", "--adjust", "lens-sheet-24-5-views", "pitch=0"}).exit_code, 78);
  EXPECT_EQ(run_dubsar({"displays", "--adjust", "no-such-panel", "pitch=50"}).exit_code, 64);
}

TEST_F(DisplaysCommand, ABadPanelFileIsToldAndLosesItsPanelOnly) {
  const fs::path panels = folder_ / "config/dubsar/panels";
  fs::create_directories(panels);
  ASSERT_TRUE(write_file_atomically(panels / "bad.json", "[1]"));
  ASSERT_TRUE(write_file_atomically(panels / "looking-glass-go.adjust.json", std::string(70000, ' ')));
  const auto found = json({"displays", "--bridge-port", "0"});
  EXPECT_EQ(found["panel_problems"].size(), 2u);
  const auto code = [&](std::vector<std::string> arguments) { return run_dubsar(arguments).exit_code; };
  const auto render = [&](const char* display) {
    return code({"render", "--pattern", "-o", file("p.png"), "--display", display});
  };
  EXPECT_EQ(render("lenticular:lens-sheet-24-5-views"), 0);
  EXPECT_EQ(render("quilt:looking-glass-go"), 78);
  EXPECT_EQ(code({"displays", "--adjust", "looking-glass-go", "center=0.1"}), 78);
  EXPECT_EQ(code({"displays", "--adjust", "looking-glass-go", "center=1e999"}), 64);
  EXPECT_EQ(code({"displays", "--adjust", "looking-glass-go", "reset"}), 0);
  EXPECT_EQ(render("quilt:looking-glass-go"), 0);
  fs::remove(panels / "bad.json");
}

TEST_F(DisplaysCommand, EveryDisplayMakesItsPicture) {
  for (const char* display : {"mono", "side_by_side:full", "top_bottom:frame_packing", "interlaced:subpixels",
                              "anaglyph:amber_blue_dubois"}) {
    const auto made = json(
        {"render", file("card.obj"), "-o", file("d.png"), "--display", display, "--size", "320x240", "--samples", "1"});
    EXPECT_EQ(made["views"], std::string(display) == "mono" ? 1 : 2) << display;
    EXPECT_EQ(made["width"], std::string(display) == "side_by_side:full" ? 640 : 320) << display;
  }
  const auto quilt = json({"render", file("card.obj"), "-o", file("q.png"), "--display",
                           "quilt:columns=3,rows=2,width=300,height=200,aspect=0.75", "--samples", "1"});
  EXPECT_EQ(quilt["output"], file("q_qs3x2a0.75.png"));
  EXPECT_EQ(read_png(file("q_qs3x2a0.75.png"))->width, 300);
}

TEST_F(DisplaysCommand, WhatAnEyeSeesIsWrittenWithItsCrosstalk) {
  const auto seen = json({"render", "--pattern", "-o", file("s.png"), "--display",
                          "lenticular:lens-sheet-24-5-views,nearest", "--see-from", "0,0,1200"});
  EXPECT_EQ(seen["main_view"], 2) << "the middle one of five";
  EXPECT_LT(seen["crosstalk_percent"].get<double>(), 5.0);
  EXPECT_EQ(seen["view_percent"].size(), 5u);
  EXPECT_EQ(read_png(file("s.png"))->width, 1920);
}

TEST_F(DisplaysCommand, OptionsThatADisplayDoesNotLookAtAreRefused) {
  const auto refused = [&](const std::string& display, std::vector<std::string> extra) {
    std::vector<std::string> arguments{"render", file("card.obj"), "-o", file("y.png"), "--display", display};
    const std::string option = extra[0];
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 64) << display << " " << option;
    EXPECT_NE(run.err.find(option), std::string::npos) << run.err;
  };
  for (const char* display : {"quilt:looking-glass-go", "lenticular:looking-glass-go"}) {
    refused(display, {"--size", "300x200"});
    refused(display, {"--viewer", "10,0,500"});
    refused(display, {"--eye-distance", "60"});
    refused(display, {"--screen-mm", "300x200"});
  }
  refused("quilt:columns=3,rows=2,width=300,height=200", {"--size", "300x200"});
  refused("lenticular:spatiallabs-15.6", {"--size", "300x200"});
  refused("mono", {"--eye-distance", "60"});
  refused("anaglyph", {"--viewer", "0,0,10"});
  refused("anaglyph", {"--viewer", "0,0,-600"});
  EXPECT_EQ(
      run_dubsar({"render", "--pattern", "-o", file("y.png"), "--display", "anaglyph", "--style", "ao"}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"view", file("card.obj"), "--offscreen", "--script", file("none.json"), "--size", "320x240",
                        "--display", "quilt:looking-glass-go"})
                .exit_code,
            64);
  for (const char* display : {"quilt:looking-glass-go", "lenticular:spatiallabs-15.6"})  // in a window, too
    EXPECT_EQ(run_dubsar({"view", file("card.obj"), "--size", "320x240", "--display", display}).exit_code, 64);
  EXPECT_FALSE(fs::exists(file("y.png")));
}

/// What opentrack sends from a maker's machine: six doubles, x to the user's left in centimetres.
class OpentrackSender {
 public:
  explicit OpentrackSender(int port) {
    socket_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    to_.sin_family = AF_INET;
    to_.sin_port = htons(static_cast<std::uint16_t>(port));
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    thread_ = std::thread([this] {
      for (int i = 0; !done_; ++i) {
        const std::array<double, 6> pose{-12.0 + 3.0 * std::sin(0.1 * i), 0, 0, 0, 0, 0};
        ::sendto(socket_, pose.data(), sizeof pose, 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    });
  }
  ~OpentrackSender() {
    done_ = true;
    thread_.join();
    ::close(socket_);
  }

 private:
  int socket_ = -1;
  sockaddr_in to_{};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

TEST_F(DisplaysCommand, ATrackersWorthBeforeAPanelIsToldLive) {
  const int port = 21000 + ::getpid() % 20000;
  const std::string input = "head:opentrack,port=" + std::to_string(port);
  {
    const OpentrackSender sender(port);
    const ProgramRun run =
        run_dubsar({"displays", "--check-eyes", "spatiallabs-15.6", "--input", input, "--seconds", "4", "--json", "-"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("% of the light is the other eye's"), std::string::npos) << run.err;
    const auto figures = nlohmann::json::parse(run.out);
    EXPECT_GE(figures["samples"], 20);
    EXPECT_NEAR(figures["left_mm"][0].get<double>(), 120 - 31.5, 31) << "12 cm to the left as opentrack counts: right";
    EXPECT_LE(figures["own_percent"].get<double>(), 6.0);
    EXPECT_GE(figures["worst_percent"].get<double>(), figures["own_percent"].get<double>());
  }
  EXPECT_EQ(
      run_dubsar({"displays", "--check-eyes", "spatiallabs-15.6", "--input", input, "--seconds", "0.6"}).exit_code, 69);
  EXPECT_EQ(
      run_dubsar({"displays", "--check-eyes", "looking-glass-go", "--input", input, "--seconds", "0.6"}).exit_code, 78);
  EXPECT_EQ(run_dubsar({"displays", "--delay-ms", "20"}).exit_code, 64);
}

TEST_F(DisplaysCommand, AQuiltsNameSaysItsLayoutOnce) {
  const std::string display = "quilt:columns=3,rows=2,width=300,height=200,aspect=0.75";
  for (const char* name : {"n.png", "n_qs3x2a0.75.png", "n_qs8x6a1.png"})
    EXPECT_EQ(json({"render", "--pattern", "-o", file(name), "--display", display})["output"],
              file("n_qs3x2a0.75.png"));
}

TEST_F(DisplaysCommand, APairThatExistsIsShownOnAnyDisplay) {
  Image pair(64, 18, 3);
  for (int y = 0; y < 18; ++y)
    for (int x = 0; x < 64; ++x) pair.at(x, y)[x < 32 ? 0 : 2] = 200;  // left red, right blue
  for (const char* name : {"pair_sbs.png", "pair_sbs.tif", "pair_sbs.jpg"}) {
    ASSERT_TRUE(write_picture(file(name), pair));
    const auto made =
        json({"show", file(name), "-o", file("a.png"), "--display", "anaglyph:red_cyan_full", "--size", "160x90"});
    EXPECT_EQ(made["layout"], "side by side") << name;
    const Image out = *read_png(file("a.png"));
    EXPECT_NEAR(out.at(80, 45)[0], 200, 4) << name << ": the left eye's red";
    EXPECT_NEAR(out.at(80, 45)[2], 200, 4) << name << ": the right eye's blue";
    EXPECT_EQ(json({"show", file(name), "-o", file("b.png"), "--display", "mono", "--swap"})["views"], 1);
    EXPECT_NEAR(read_png(file("b.png"))->at(960, 540)[2], 200, 4) << "exchanged: the left one is blue";
  }
  const auto quilt = json({"show", file("pair_sbs.png"), "-o", file("c.jpg"), "--display",
                           "quilt:columns=4,rows=1,width=128,height=18,aspect=1.7778"});
  EXPECT_EQ(quilt["output"], file("c_qs4x1a1.7778.jpg"));
  const auto seen = json({"show", file("c_qs4x1a1.7778.jpg"), "-o", file("d.png"), "--display",
                          "lenticular:spatiallabs-15.6", "--see-from", "31.5,0,600", "--cone", "30"});
  EXPECT_EQ(seen["input_views"], 4);
  EXPECT_EQ(seen["main_view"], 1);
  EXPECT_GT(read_png(file("d.png"))->at(1920, 1080)[2], 180) << "the right eye sees the right half's blue";
  EXPECT_LT(read_png(file("d.png"))->at(1920, 1080)[0], 60);
  const auto code = [&](std::vector<std::string> arguments) { return run_dubsar(arguments).exit_code; };
  EXPECT_EQ(code({"show", file("pair_sbs.png"), "-o", file("e.png")}), 64);
  EXPECT_EQ(code({"show", file("pair_sbs.png"), "--display", "mono"}), 64);
  EXPECT_EQ(code({"show", file("pair_sbs.png"), "-o", file("pair_sbs.png"), "--display", "mono"}), 64);
  EXPECT_EQ(code({"show", file("c_qs4x1a1.7778.jpg"), "-o", file("c.jpg"), "--display",
                  "quilt:columns=4,rows=1,width=128,height=18,aspect=1.7778"}),
            64)
      << "with its suffix the product's name is that of the picture that is shown";
  EXPECT_EQ(code({"show", file("pair_sbs.png"), "-o", file("e.png"), "--display", "mono", "--layout", "sideways"}), 64);
  EXPECT_EQ(code({"show", file("pair_sbs.png"), "-o", file("e.png"), "--display", "mono", "--layout", "qs9x1"}), 65);
  EXPECT_EQ(code({"show", file("none_sbs.png"), "-o", file("e.png"), "--display", "mono"}), 66);
  EXPECT_FALSE(fs::exists(file("e.png")));
}

TEST_F(DisplaysCommand, PicturesSayHowManyDotsAnInchThePanelHas) {
  ASSERT_EQ(run_dubsar({"render", "-o", file("dots.png"), "--pattern", "--display", "interlaced", "--size", "640x360",
                        "--screen-mm", "320x180"})
                .exit_code,
            0);
  std::ifstream stream(file("dots.png"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  // PNG, pHYs: pixels a metre across and down, then 1 for metres. 640 pixels on 320 mm are 2000.
  EXPECT_NE(bytes.find(std::string("pHYs\0\0\x07\xd0\0\0\x07\xd0\x01", 13)), std::string::npos);
}

TEST_F(DisplaysCommand, OptionsThatContradictAreUsageErrors) {
  const auto code = [&](std::vector<std::string> extra) {
    std::vector<std::string> arguments{"render", "-o", file("x.png")};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    return run_dubsar(arguments).exit_code;
  };
  EXPECT_EQ(code({}), 64);
  EXPECT_EQ(code({"--pattern"}), 64);
  EXPECT_EQ(code({"--display", "mono"}), 64);
  EXPECT_EQ(code({file("card.obj"), "--pattern", "--display", "mono"}), 64);
  EXPECT_EQ(code({file("card.obj"), "--see-from", "0,0,600"}), 64);
  EXPECT_EQ(code({"--pattern", "--display", "anaglyph", "--see-from", "0,0,600"}), 64);
  EXPECT_EQ(code({"--pattern", "--display", "lenticular:sr-32", "--see-from", "0,0"}), 64);
  EXPECT_EQ(code({file("card.obj"), "--display", "mono", "--perspective"}), 64);
  EXPECT_EQ(code({"--pattern", "--display", "quad_buffer"}), 69);
  for (const char* viewer : {"0,0,-600", "0,0,0", "0,0,19"})
    EXPECT_EQ(code({"--pattern", "--display", "anaglyph", "--viewer", viewer}), 64) << "behind the panel, or in it";
  EXPECT_FALSE(fs::exists(file("x.png")));
}

}  // namespace
}  // namespace dubsar::test
