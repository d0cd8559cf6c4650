// Sinks without GL: which views they want, and their CPU references on painted views.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "display/sinks/anaglyph.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "display/sinks/interlaced.h"
#include "display/sinks/packed.h"
#include "display/sinks/quilt.h"
#include "tests/display/reference_pictures.h"

namespace dubsar {
namespace {
using testing::anaglyph_views;
using testing::interlace_views;
using testing::make_quilt;

Image painted(int width, int height, std::array<std::uint8_t, 3> color) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) std::copy_n(color.data(), 3, image.at(x, y));
  return image;
}
const Image& red() {
  static const Image image = painted(6, 4, {255, 0, 0});
  return image;
}

TEST(SinkCatalogTest, EverySinkIsMadeByItsNameAndAsksForWhatItSays) {
  std::set<std::string_view> names;
  for (const SinkBackend& backend : output_sinks()) {
    names.insert(backend.name);
    if (backend.name == "openxr") continue;  // asks a runtime: tests/display/headset
    const std::string spec = std::string(backend.name) + (backend.name == "image"        ? ":path=/nowhere/a.png"
                                                          : backend.name == "lenticular" ? ":spatiallabs-15.6"
                                                                                         : "");
    auto sink = SinkCatalog().make(spec);
    ASSERT_TRUE(sink) << sink.error().message;
    Screen screen{.window_x = 5, .window_y = 7, .window_w = 64, .window_h = 48};
    ASSERT_TRUE((*sink)->configure(screen));
    const SinkTraits traits = (*sink)->traits();
    EXPECT_EQ(traits.name, backend.name);
    EXPECT_EQ((*sink)->views(Observer()).size(), static_cast<std::size_t>(traits.views)) << spec;
    EXPECT_GE(traits.view.width, 1);
    EXPECT_GE(traits.output.height, traits.view.height);
    screen.window_w = 0;
    EXPECT_FALSE((*sink)->configure(screen)) << spec;
  }
  EXPECT_EQ(names.size(), output_sinks().size());
}

TEST(SinkCatalogTest, WrongNamesAndOptionsAreUsageErrorsThatSayWhatThereIs) {
  for (const char* bad : {"",
                          "hologram",
                          "mono:half",
                          "shutter:half",
                          "side_by_side:frame_packing",
                          "side_by_side:half,full",
                          "top_bottom:frame_packing,right_first",
                          "interlaced:diagonal",
                          "interlaced:rows=1",
                          "anaglyph:pink",
                          "anaglyph:red_cyan_full,red_cyan_half",
                          "quilt:no-such-panel",
                          "quilt:columns=0",
                          "quilt:columns=2.5",
                          "quilt:columns=x",
                          "quilt:width=40,columns=8",
                          "image",
                          "image:path=a.jpg",
                          "image:path=a%%.png",
                          "lenticular",
                          "lenticular:no-such-panel",
                          "lenticular:spatiallabs-15.6,blurred"}) {
    const auto sink = SinkCatalog().make(bad);
    ASSERT_FALSE(sink) << bad;
    EXPECT_EQ(sink.error().kind, ErrorKind::kUsage) << bad;
    EXPECT_NE(sink.error().message.find("expected"), std::string::npos) << sink.error().message;
  }
}

TEST(Packed, SizesAndPlacesOfEveryKind) {
  const struct {
    Packing packing;
    PixelSize window, view, output, left, right;
  } cases[] = {{{}, {1920, 1080}, {960, 1080}, {1920, 1080}, {0, 0}, {960, 0}},
               {{.right_first = true}, {1920, 1080}, {960, 1080}, {1920, 1080}, {960, 0}, {0, 0}},
               {{.full = true}, {1920, 1080}, {1920, 1080}, {3840, 1080}, {0, 0}, {1920, 0}},
               {{.vertical = true}, {1920, 1080}, {1920, 540}, {1920, 1080}, {0, 0}, {0, 540}},
               {{.vertical = true, .full = true, .right_first = true},
                {1920, 1080},
                {1920, 1080},
                {1920, 2160},
                {0, 1080},
                {0, 0}},
               {{.vertical = true, .full = true, .frame_packing = true},
                {1920, 1080},
                {1920, 1080},
                {1920, 2205},
                {0, 0},
                {0, 1125}},
               {{.vertical = true, .full = true, .frame_packing = true},
                {1280, 720},
                {1280, 720},
                {1280, 1470},
                {0, 0},
                {0, 750}},
               {{}, {7, 3}, {3, 3}, {7, 3}, {0, 0}, {4, 0}}};
  for (const auto& c : cases) {
    EXPECT_EQ(c.packing.view_size(c.window), c.view);
    EXPECT_EQ(c.packing.output_size(c.window), c.output);
    EXPECT_EQ(c.packing.place(c.window, 0), c.left);
    EXPECT_EQ(c.packing.place(c.window, 1), c.right);
  }
}

TEST(Packed, HalfViewsLookThroughTheWholeWindow) {
  auto half = SinkCatalog().make("side_by_side:half"), full = SinkCatalog().make("side_by_side:full");
  ASSERT_TRUE(half && full);
  ASSERT_TRUE((*half)->configure({}) && (*full)->configure({}));
  for (int eye = 0; eye < 2; ++eye)
    EXPECT_EQ((*half)->views(Observer())[eye].clip_from_world(), (*full)->views(Observer())[eye].clip_from_world());
}

TEST(Stereo, TheFirstViewIsTheLeftEyesInEveryTwoViewSink) {
  for (const char* spec : {"side_by_side", "side_by_side:right_first", "top_bottom", "interlaced", "anaglyph"}) {
    auto sink = SinkCatalog().make(spec);
    ASSERT_TRUE(sink);
    ASSERT_TRUE((*sink)->configure({}));
    const auto views = (*sink)->views(Observer());
    EXPECT_EQ(views[0].view_from_world[3][0], 31.5) << spec;
    EXPECT_EQ(views[1].view_from_world[3][0], -31.5) << spec;
  }
}

TEST(Interlaced, PatternsFollowThePanelAndNotTheWindow) {
  const Image blue = painted(6, 4, {0, 0, 255});
  for (const auto& [x0, y0] : {std::pair{0, 0}, {1, 0}, {0, 1}, {13, 8}}) {
    const Screen screen{.window_x = x0, .window_y = y0, .window_w = 6, .window_h = 4};
    for (const bool right_first : {false, true}) {
      const Image rows = interlace_views(red(), blue, screen, InterlacePattern::kRows, right_first);
      const Image columns = interlace_views(red(), blue, screen, InterlacePattern::kColumns, right_first);
      const Image squares = interlace_views(red(), blue, screen, InterlacePattern::kCheckerboard, right_first);
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x) {
          const auto shows_left = [&](const Image& image) { return image.at(x, y)[0] == 255; };
          EXPECT_EQ(shows_left(rows), ((y0 + y) % 2 == 0) != right_first);
          EXPECT_EQ(shows_left(columns), ((x0 + x) % 2 == 0) != right_first);
          EXPECT_EQ(shows_left(squares), ((x0 + x + y0 + y) % 2 == 0) != right_first);
        }
    }
  }
}

TEST(Interlaced, NeighbouringSubpixelsBelongToDifferentEyes) {
  const Image white = painted(6, 4, {255, 255, 255}), black = painted(6, 4, {0, 0, 0});
  const Screen screen{.window_x = 3, .window_y = 2, .window_w = 6, .window_h = 4};
  const Image image = interlace_views(white, black, screen, InterlacePattern::kSubpixels, false);
  EXPECT_EQ(image.at(0, 0)[0], 0) << "panel subpixel 9 is odd: the right eye's";
  for (int y = 0; y < 4; ++y)
    for (int i = 1; i < 18; ++i) EXPECT_EQ(image.at(i / 3, y)[i % 3], 255 - image.at((i - 1) / 3, y)[(i - 1) % 3]);
}

TEST(Anaglyph, FullColourKeepsTheChannelsOfEachEye) {
  Image left(2, 1, 3), right(2, 1, 3);
  left.pixels = {10, 20, 30, 40, 50, 60};
  right.pixels = {110, 120, 130, 140, 150, 160};
  const auto mixed = [&](std::string_view name) {
    for (const AnaglyphVariant& v : anaglyph_variants())
      if (v.name == name) return anaglyph_views(left, right, v).pixels;
    return std::vector<std::uint8_t>();
  };
  EXPECT_EQ(mixed("red_cyan_full"), (std::vector<std::uint8_t>{10, 120, 130, 40, 150, 160}));
  EXPECT_EQ(mixed("green_magenta_full"), (std::vector<std::uint8_t>{110, 20, 130, 140, 50, 160}));
  EXPECT_EQ(mixed("amber_blue_full"), (std::vector<std::uint8_t>{10, 20, 130, 40, 50, 160}));
}

TEST(Anaglyph, GreyStaysGreyWhereTheMatricesSaySo) {
  // A grey picture without depth: half and mono variants must show the same grey in the channels that they use.
  const Image grey = painted(1, 1, {120, 120, 120});
  int variants = 0;
  for (const AnaglyphVariant& v : anaglyph_variants()) {
    const Image out = anaglyph_views(grey, grey, v);
    for (int c = 0; c < 3; ++c) {
      const double sum = v.left[0][c] + v.left[1][c] + v.left[2][c] + v.right[0][c] + v.right[1][c] + v.right[2][c];
      if (v.name.ends_with("dubois")) {
        EXPECT_NEAR(sum, 1.0, 0.2) << v.name << " channel " << c;
      } else {
        EXPECT_TRUE(std::abs(sum) < 1e-12 || std::abs(sum - 1) < 1e-12) << v.name << " channel " << c;
        EXPECT_EQ(out.at(0, 0)[c], sum > 0.5 ? 120 : 0) << v.name << " channel " << c;
      }
    }
    ++variants;
  }
  EXPECT_EQ(variants, 14);
}

TEST(Anaglyph, DuboisRedCyanSendsLeftMostlyToRed) {
  const Image white = painted(1, 1, {255, 255, 255}), black = painted(1, 1, {0, 0, 0});
  const AnaglyphVariant& dubois = anaglyph_variants()[0];
  const Image left_only = anaglyph_views(white, black, dubois), right_only = anaglyph_views(black, white, dubois);
  EXPECT_EQ(left_only.pixels, (std::vector<std::uint8_t>{255, 0, 0}));
  EXPECT_EQ(right_only.at(0, 0)[0], 0);
  EXPECT_EQ(right_only.at(0, 0)[1], 255);
  EXPECT_EQ(right_only.at(0, 0)[2], 255);
}

TEST(Quilt, NamesAreWrittenStrictlyAndReadTolerantly) {
  EXPECT_EQ(quilt_suffix(8, 6, 0.75), "_qs8x6a0.75");
  EXPECT_EQ(quilt_suffix(5, 9, 16.0 / 9), "_qs5x9a1.7778");
  EXPECT_EQ(quilt_suffix(11, 6, 0.5625), "_qs11x6a0.5625");
  for (const auto& [given, expected] : {std::pair{"d/tablet.png", "d/tablet_qs8x6a0.75.png"},
                                        {"d/tablet_qs8x6a0.75.png", "d/tablet_qs8x6a0.75.png"},
                                        {"tablet_qs5x9a1.7778.tif", "tablet_qs8x6a0.75.tif"},
                                        {"tablet_qs8x6.png", "tablet_qs8x6a0.75.png"},
                                        {"tablet_qs8x6a0.75_new.png", "tablet_new_qs8x6a0.75.png"},
                                        {"tablet_qs8x6a0.75_qs8x6a0.75.png", "tablet_qs8x6a0.75.png"},
                                        {"a_qs.png", "a_qs_qs8x6a0.75.png"}})
    EXPECT_EQ(name_with_suffix(given, "_qs8x6a0.75"), expected);
  EXPECT_EQ(name_with_suffix("a_qs8x6a0.75.png", ""), "a_qs8x6a0.75.png");
  const struct {
    const char* text;
    int columns, rows;
    double aspect;
  } good[] = {{"tablet_qs8x6a0.75.png", 8, 6, 0.75},
              {"/a_qs2x2/tablet_qs11x6a0.5625.tif", 11, 6, 0.5625},
              {"tablet_qs5x9.png", 5, 9, 0},
              {"tablet_qs5x9a1.6.e.png", 5, 9, 1.6},
              {"_qs7x7a1", 7, 7, 1}};
  for (const auto& g : good) {
    const auto name = parse_quilt_name(g.text);
    ASSERT_TRUE(name) << g.text;
    EXPECT_EQ(name->columns, g.columns);
    EXPECT_EQ(name->rows, g.rows);
    EXPECT_EQ(name->aspect.value_or(0), g.aspect);
  }
  for (const char* bad : {"", "tablet.png", "tablet_qs.png", "tablet_qs8.png", "_qs8x.png", "_qsx6", "_qs0x6",
                          "_qs-8x6", "_qs101x2", "_qs8x6a0", "_qs8x6ax", "_qs8x6a-1", "_qs99999999999x1"})
    EXPECT_FALSE(parse_quilt_name(bad)) << bad;
}

TEST(Quilt, ViewZeroIsAtTheLowerLeftAndPaddingIsBlack) {
  const QuiltLayout layout{3, 2, 32, 21};  // tiles of 10 x 10, 2 columns and 1 row left over
  std::vector<Image> views;
  for (int i = 0; i < 6; ++i) views.push_back(painted(10, 10, {static_cast<std::uint8_t>(40 * i + 10), 0, 1}));
  const Image quilt = make_quilt(views, layout);
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool padding = x >= 30 || y < 1;
      const int view = (20 - y) / 10 * 3 + x / 10;
      EXPECT_EQ(quilt.at(x, y)[0], padding ? 0 : 40 * view + 10) << x << ", " << y;
    }
  const auto back = split_quilt(quilt, layout);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(back[i].pixels, views[i].pixels);
}

TEST(Quilt, SinkTakesItsLayoutFromThePanelProfile) {
  auto sink = SinkCatalog().make("quilt:looking-glass-portrait");
  ASSERT_TRUE(sink) << sink.error().message;
  const SinkTraits traits = (*sink)->traits();
  EXPECT_EQ(traits.views, 48);
  EXPECT_EQ(traits.view, (PixelSize{420, 560}));
  EXPECT_EQ(traits.output, (PixelSize{3360, 3360}));
  EXPECT_EQ(traits.file_suffix, "_qs8x6a0.75");
  const auto views = (*sink)->views(Observer());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto eye_x = [&](std::size_t view) { return -views[view].view_from_world[3][0]; };
    EXPECT_NEAR(eye_x(i), -eye_x(views.size() - 1 - i), 1e-9) << "cameras are not symmetric";
    EXPECT_TRUE(i == 0 || eye_x(i - 1) < eye_x(i)) << "view 0 is the leftmost";
  }
}

TEST(Quilt, SizesCanBeGiven) {
  auto sink = SinkCatalog().make("quilt:columns=4,rows=2,width=402,height=201,aspect=1.5,cone=30");
  ASSERT_TRUE(sink) << sink.error().message;
  EXPECT_EQ((*sink)->traits().view, (PixelSize{100, 100}));
  EXPECT_EQ((*sink)->traits().file_suffix, "_qs4x2a1.5");
  const View first = (*sink)->views(Observer())[0];
  EXPECT_NEAR(first.clip_from_view[1][1] / first.clip_from_view[0][0], 1.5, 1e-9) << "panel aspect, not tile aspect";
}

}  // namespace
}  // namespace dubsar
