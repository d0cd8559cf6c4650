// Lifting the envelope away and putting it back, by number and by key: the picture is the same to the last byte.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/base/files/atomic_file.h"
#include "core/image_io/png_file.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

TEST(Unpack, ThereAndBackShowsTheSameTabletToTheLastByte) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_unpack_{}", ::getpid());
  fs::create_directories(folder);
  const auto in = [&](const char* name) { return (folder / name).string(); };
  ASSERT_EQ(run_dubsar({"phantom", in("s.h5"), "--preset", "tiny", "-q"}).exit_code, 0);
  ASSERT_EQ(run_dubsar({"process", in("s.h5"), "-o", in("s.exa"), "--no-ao", "-q"}).exit_code, 0);
  std::ofstream(in("steps.txt")) << "0 picture " << in("first.png") << "\n+0.2 unpack 100\n+0.2 picture "
                                 << in("apart.png") << "\n+0.2 unpack 37\n+0.2 unpack 0\n+0.2 picture "
                                 << in("back.png") << "\n+0.2 unpack_more\n+0.2 unpack_less\n+0.2 picture "
                                 << in("keys.png") << "\n+0.2 unpack 60\n+0.2 undo\n+0.2 picture " << in("undone.png")
                                 << "\n";
  const ProgramRun run = run_dubsar(
      {"view", in("s.exa"), "--offscreen", "--size", "320x240", "--steps", in("steps.txt"), "--every", "100", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto bytes = [&](const char* name) { return read_text_file(in(name), 1 << 24).value_or(name); };
  EXPECT_GT(bytes("first.png").size(), 2000u);
  EXPECT_EQ(bytes("back.png"), bytes("first.png"));
  EXPECT_EQ(bytes("keys.png"), bytes("first.png"));
  EXPECT_EQ(bytes("undone.png"), bytes("first.png"));
  EXPECT_NE(bytes("apart.png"), bytes("first.png"));
  fs::remove_all(folder);
}

class UnpackedPicture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_unpacked_{}", ::getpid());
    fs::create_directories(folder_);
    ASSERT_EQ(run_dubsar({"phantom", in("s.h5"), "--preset", "tiny", "-q"}).exit_code, 0);
    ASSERT_EQ(run_dubsar({"process", in("s.h5"), "-o", in("s.exa"), "--no-ao", "-q"}).exit_code, 0);
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  static std::string in(const char* name) { return (folder_ / name).string(); }
  static Image picture(std::vector<std::string> options) {
    options.insert(options.begin(), {"render", in("s.exa"), "-o", in("p.png"), "--samples", "1"});
    const ProgramRun run = run_dubsar(options);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.exit_code == 0 ? read_png(in("p.png")).value() : Image(1, 1, 3);
  }
  static bool ground(const Image& image, int x, int y) {
    const std::uint8_t *const p = image.at(x, y), *const corner = image.at(0, 0);
    return p[0] == corner[0] && p[1] == corner[1] && p[2] == corner[2];
  }
  struct Extent {
    int left = 1 << 30, right = -1, top = 1 << 30, bottom = -1;
    std::int64_t pixels = 0;
  };
  static Extent extent(const Image& image) {
    Extent out;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (!ground(image, x, y))
          out = {std::min(out.left, x), std::max(out.right, x), std::min(out.top, y), std::max(out.bottom, y),
                 out.pixels + 1};
    return out;
  }
  inline static fs::path folder_;
};

// Whole: nothing of it at the picture's sides. Both: as many pixels as each alone at the same scale.
TEST_F(UnpackedPicture, HasAllOfTheEnvelopeAndOfTheTablet) {
  for (const char* view : {"front", "left", "orbit:25,20", "top"})
    for (const char* percent : {"40", "100"}) {
      const Image both = picture({"--unpack", percent, "--view", view, "--size", "300x300"});
      const Extent seen = extent(both);
      EXPECT_GT(seen.left, 2) << view << percent;
      EXPECT_GT(seen.top, 2) << view << percent;
      EXPECT_LT(seen.right, 297) << view << percent;
      EXPECT_LT(seen.bottom, 297) << view << percent;
      EXPECT_GT(std::max(seen.right - seen.left, seen.bottom - seen.top), 230) << "as large as fits";
    }
  const auto count = [&](std::vector<std::string> options) {
    options.insert(options.end(), {"--view", "front", "--mm-per-pixel", "0.05"});
    return static_cast<double>(extent(picture(options)).pixels);
  };
  const double tablet = count({"--partition", "tablet"}), envelope = count({"--partition", "envelope"});
  const double apart = count({"--unpack", "100"});
  EXPECT_NEAR(apart, tablet + envelope, 0.01 * apart);
}

TEST_F(UnpackedPicture, OfADisplayHasAllOfItToo) {
  const Extent seen = extent(picture({"--unpack", "100", "--display", "mono", "--size", "300x300"}));
  EXPECT_GT(std::min(seen.left, seen.top), 2);
  EXPECT_LT(std::max(seen.right, seen.bottom), 297);
}

TEST_F(UnpackedPicture, AScaleWithoutASizeMakesThePictureAsLargeAsTheObject) {
  const Extent coarse = extent(picture({"--mm-per-pixel", "0.08"})), fine = extent(picture({"--mm-per-pixel", "0.02"}));
  EXPECT_NEAR(fine.right - fine.left, 4 * (coarse.right - coarse.left), 8);
  for (const char* view : {"front", "orbit:25,15", "right"}) {
    const Image image = picture({"--mm-per-pixel", "0.03", "--view", view});
    const Extent seen = extent(image);
    EXPECT_GT(std::min(seen.left, seen.top), 0) << view;
    EXPECT_LT(seen.right, image.width - 1) << view;
    EXPECT_LT(seen.bottom, image.height - 1) << view;
  }
}

TEST_F(UnpackedPicture, AScaleThatWouldCutTheObjectIsRefusedWithTheSizeThatItTakes) {
  const Extent seen = extent(picture({"--mm-per-pixel", "0.05"}));
  const int width = seen.right - seen.left + 1, height = seen.bottom - seen.top + 1;
  const auto with = [&](int w, int h) {
    return run_dubsar(
        {"render", in("s.exa"), "-o", in("cut.png"), "--mm-per-pixel", "0.05", "--size", fmt::format("{}x{}", w, h)});
  };
  EXPECT_EQ(with(width + 4, height + 4).exit_code, 0);
  fs::remove(in("cut.png"));
  for (const auto& [w, h] : {std::pair{width / 2, height + 4}, std::pair{width + 4, height - 8}}) {
    const ProgramRun cut = with(w, h);
    EXPECT_EQ(cut.exit_code, 64);
    EXPECT_NE(cut.err.find(fmt::format("{} x {} pixels found, expected at least", w, h)), std::string::npos) << cut.err;
    EXPECT_FALSE(fs::exists(in("cut.png")));
  }
}

}  // namespace
}  // namespace dubsar::test
