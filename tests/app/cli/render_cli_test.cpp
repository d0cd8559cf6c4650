// Pictures as the user gets them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "core/base/files/atomic_file.h"
#include "core/image_io/png_file.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

class RenderCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_render_{}", ::getpid());
    fs::create_directories(folder_);
    ASSERT_EQ(run_dubsar({"phantom", file("scan.h5"), "--preset", "tiny"}).exit_code, 0);
    ASSERT_EQ(
        run_dubsar({"process", file("scan.h5"), "-o", file("tablet.exa"), "--detail", "half", "--quiet"}).exit_code, 0);
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  static std::string file(const char* name) { return (folder_ / name).string(); }
  inline static fs::path folder_;
};

double lit_fraction(const Image& image) {
  std::int64_t lit = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t *pixel = image.at(x, y), *corner = image.at(0, 0);
      lit += std::abs(pixel[0] - corner[0]) + std::abs(pixel[1] - corner[1]) + std::abs(pixel[2] - corner[2]) > 24;
    }
  return static_cast<double>(lit) / image.width / image.height;
}

TEST_F(RenderCommand, ThePictureShowsTheObjectOnABackground) {
  const ProgramRun run = run_dubsar({"render", file("tablet.exa"), "-o", file("a.png"), "--size", "320x240"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto image = read_png(file("a.png"));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 320);
  EXPECT_EQ(image->height, 240);
  EXPECT_GT(lit_fraction(*image), 0.2);
  EXPECT_LT(lit_fraction(*image), 0.95);
}

TEST_F(RenderCommand, EverySideAndStyleGivesAnotherPicture) {
  std::set<std::string> pictures;
  const auto add = [&](const std::vector<std::string>& extra) {
    std::vector<std::string> arguments{"render", file("tablet.exa"), "-o",        file("b.png"),
                                       "--size", "160x160",          "--samples", "1"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const ProgramRun run = run_dubsar(arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Image image = *read_png(file("b.png"));
    pictures.emplace(image.pixels.begin(), image.pixels.end());
  };
  for (const char* view : {"front", "back", "left", "right", "top", "bottom", "orbit", "orbit:70,-20"})
    add({"--view", view});
  for (const char* style : {"phong", "table", "black-white", "sky-sun", "ao"}) add({"--style", style});
  add({"--colour-parts"});
  EXPECT_EQ(pictures.size(), 14u);
}

TEST_F(RenderCommand, ATiffIsWrittenAndUnknownPartsAreRefused) {
  EXPECT_EQ(run_dubsar({"render", file("tablet.exa"), "-o", file("a.tif"), "--size", "64x64"}).exit_code, 0);
  const auto tiff = read_text_file(file("a.tif"));
  ASSERT_TRUE(tiff);
  EXPECT_EQ(tiff->substr(0, 2), "II");
  EXPECT_EQ(run_dubsar({"render", file("tablet.exa"), "-o", file("c.png"), "--partition", "lid"}).exit_code, 64);
  EXPECT_FALSE(fs::exists(file("c.png")));
}

TEST_F(RenderCommand, AFigureHasItsWidthInPrintItsGroundAndABarOfItsLength) {
  const auto figure = [&](const std::vector<std::string>& extra) {
    std::vector<std::string> arguments{"render", file("tablet.exa"), "-o", file("figure.png"), "--samples",
                                       "1",      "--json",           "-"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(run.out.substr(run.out.find('{')));
  };
  const auto told = figure({"--width-mm", "50", "--dpi", "300", "--ground", "white", "--scale-bar", "--labels"});
  EXPECT_EQ(told["width"], 591) << "50 mm at 300 dots an inch";
  EXPECT_EQ(told["dpi"], 300.0);
  EXPECT_NEAR(told["bar_px"].get<double>() * told["mm_per_pixel"].get<double>(), told["bar_mm"].get<double>(),
              0.5 * told["mm_per_pixel"].get<double>());
  const Image white = *read_png(file("figure.png"));
  EXPECT_EQ(white.width, 591);
  EXPECT_EQ(white.channels, 3);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(white.at(0, 0)[c], 255);
  int dark = 0;  // the bar and the words: black on white, below the object
  for (int y = white.height - 70; y < white.height; ++y)
    for (int x = 0; x < white.width; ++x) dark += white.at(x, y)[0] < 40 ? 1 : 0;
  EXPECT_GT(dark, told["bar_px"].get<int>());
  const auto life = figure({"--dpi", "254"});
  EXPECT_NEAR(life["mm_per_pixel"].get<double>(), 0.1, 1e-12);
  figure({"--width-mm", "20", "--ground", "none"});
  const Image clear = *read_png(file("figure.png"));
  ASSERT_EQ(clear.channels, 4);
  EXPECT_EQ(clear.at(0, 0)[3], 0);
  EXPECT_EQ(
      run_dubsar({"render", file("tablet.exa"), "-o", file("x.png"), "--dpi", "300", "--size", "64x64"}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"render", file("tablet.exa"), "-o", file("x.png"), "--dpi", "300", "--perspective"}).exit_code,
            64);
  EXPECT_EQ(run_dubsar({"render", file("tablet.exa"), "-o", file("x.png"), "--mm-per-pixel", "0.01", "--size", "64x64"})
                .exit_code,
            64)
      << "the whole tablet or an error";
}

TEST_F(RenderCommand, ATextGoesInAndOutByCommandsAndStandsBesideTheHandCopy) {
  const std::string text = "&P999001 = AO 0\n#atf: lang akk\n@tablet\n@obverse\n1. a-na\n2. \u0161u-mi\n";
  ASSERT_TRUE(write_file_atomically(file("in.atf"), std::string_view(text)));
  const ProgramRun told = run_dubsar({"render", file("tablet.exa"), "-o", file("told.png"), "--size", "64x64", "--do",
                                      "read_atf " + file("in.atf"), "--do", "write_atf " + file("out.atf")});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  EXPECT_EQ(read_text_file(file("out.atf")).value(), text);
  const ProgramRun copied =
      run_dubsar({"handcopy", file("tablet.exa"), "-o", file("copy.svg"), "--atf", file("in.atf"), "--width", "2"});
  ASSERT_EQ(copied.exit_code, 0) << copied.err;
  const std::string svg = read_text_file(file("copy.svg")).value();
  EXPECT_NE(svg.find(">\u0161u-mi</text>"), std::string::npos);
  EXPECT_NE(svg.find(">AO 0</text>"), std::string::npos) << "its title";
}

TEST_F(RenderCommand, ASurfaceComparedWithItselfIsTheSame) {
  const ProgramRun run =
      run_dubsar({"compare", file("tablet.exa"), file("tablet.exa"), "-o", file("same.ply"), "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto told = nlohmann::json::parse(run.out.substr(run.out.find('{')));
  EXPECT_LT(told["rms_mm"].get<double>(), 1e-4);
  EXPECT_GT(told["within_0.05_mm"].get<double>(), 0.9999);
  EXPECT_EQ(run_dubsar({"render", file("same.ply"), "-o", file("same.png"), "--size", "64x64", "--style", "photograph"})
                .exit_code,
            0);
}

TEST_F(RenderCommand, APlyLooksLikeTheExaItCameFrom) {
  ASSERT_EQ(run_dubsar({"export", file("tablet.exa"), file("tablet.ply")}).exit_code, 0);
  for (const char* in : {"tablet.exa", "tablet.ply"}) {
    const std::string out = file(in) + ".png";
    ASSERT_EQ(run_dubsar({"render", file(in), "-o", out, "--size", "200x200", "--samples", "1"}).exit_code, 0);
  }
  const auto a = read_png(file("tablet.exa.png")), b = read_png(file("tablet.ply.png"));
  ASSERT_TRUE(a && b);
  double difference = 0.0;
  for (std::size_t i = 0; i < a->pixels.size(); ++i) difference += std::abs(int{a->pixels[i]} - int{b->pixels[i]});
  EXPECT_LT(difference / static_cast<double>(a->pixels.size()), 2.0);
}

}  // namespace
}  // namespace dubsar::test
