// The fat-cross: exact scale, its layout, its ruler, and files as other programs read them.

#include "app/publish/fat_cross.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "app/panels/panel_font.h"
#include "app/publish/xmp.h"
#include "core/image_io/tiff_file.h"
#include "display/render/mesh/surface_field.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A box with its corner at the origin, edges in mm.
TriMesh box(double x, double y, double z) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back(glm::vec3(i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? z : 0));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  mesh.frame.input_voxel.provenance = "made";
  return mesh;
}

TEST(FatCross, ACubeOfTenMillimetresSpans236PixelsOnEverySide) {
  SilentProgress progress;
  const auto cross = draw_fat_cross(box(10.0, 10.0, 10.0), {}, progress);
  ASSERT_TRUE(cross) << cross.error().message;
  for (const Image& side : cross->sides) {
    EXPECT_NEAR(side.width, 236, 1);
    EXPECT_NEAR(side.height, 236, 1);
    int lit = 0;  // along the middle row
    for (int x = 0; x < side.width; ++x) lit += side.at(x, side.height / 2)[0] > 30;
    EXPECT_NEAR(lit, 236, 1);
  }
  EXPECT_EQ(cross->ruler_mm, 10);
  EXPECT_NEAR(cross->ruler_px, 10.0 / 25.4 * 600.0, 1.0);
}

TEST(FatCross, ProgressIsOfTheSixSidesAndStopsInTheMidst) {
  class Third final : public Progress {
   public:
    std::vector<std::string> stages;
    std::vector<std::int64_t> done;

   protected:
    void on_begin(std::string_view stage, std::int64_t total, std::string_view) override {
      stages.emplace_back(stage);
      EXPECT_EQ(total, 6);
    }
    void on_advance(std::int64_t now) override {
      done.push_back(now);
      if (now == 3) cancel();
    }
  } progress;
  const auto cross = draw_fat_cross(box(10.0, 10.0, 10.0), {}, progress);
  ASSERT_FALSE(cross);
  EXPECT_EQ(cross.error().kind, ErrorKind::kCancelled);
  EXPECT_EQ(progress.stages, std::vector<std::string>{"draw the sides"});
  EXPECT_EQ(progress.done, (std::vector<std::int64_t>{1, 2, 3}));
}

TEST(FatCross, WhatAStyleHasToMeasureIsAStageOfItsOwnBeforeTheSides) {
  class Stages final : public Progress {
   public:
    std::vector<std::string> stages;

   protected:
    void on_begin(std::string_view stage, std::int64_t, std::string_view) override { stages.emplace_back(stage); }
  } progress;
  FatCrossOptions options;
  options.shading = shading_preset("mean-curvature").value();
  ASSERT_TRUE(draw_fat_cross(box(10.0, 10.0, 10.0), options, progress));
  EXPECT_EQ(progress.stages, (std::vector<std::string>{"curvature", "draw the sides"}));
}

TEST(FatCross, SidesOfAPlateHaveItsThreeEdges) {
  SilentProgress progress;
  FatCrossOptions options;
  options.dpi = 254.0;  // 10 pixels a millimetre
  options.ground = {255, 255, 255};
  const auto cross = draw_fat_cross(box(52.0, 31.0, 12.0), options, progress);
  ASSERT_TRUE(cross);
  const auto expect = [&](TabletSide side, int width, int height) {
    const Image& image = cross->sides[static_cast<std::size_t>(side)];
    EXPECT_NEAR(image.width, width, 1);
    EXPECT_NEAR(image.height, height, 1);
  };
  expect(TabletSide::kObverse, 520, 310);
  expect(TabletSide::kReverse, 520, 310);
  expect(TabletSide::kUpper, 520, 120);
  expect(TabletSide::kLower, 520, 120);
  expect(TabletSide::kLeft, 120, 310);
  expect(TabletSide::kRight, 120, 310);
  EXPECT_EQ(cross->ruler_mm, 50);
  EXPECT_EQ(cross->ruler_px, 500);
  EXPECT_EQ(cross->whole.at(0, 0)[0], 255);
}

TEST(FatCross, PicturesOfTheLayoutNeverOverlap) {
  const std::array<PixelExtent, 6> sides{{{520, 310}, {520, 310}, {500, 120}, {510, 121}, {120, 310}, {90, 300}}};
  const CrossLayout layout = lay_out_cross(sides, {200, 60}, 100, {420, 90});
  struct Rectangle {
    int x0, y0, x1, y1;
  };
  std::vector<Rectangle> placed;
  const auto add = [&](const CrossPlace& p, const PixelExtent& e) {
    placed.push_back({p.x, p.y, p.x + e.width, p.y + e.height});
  };
  const std::array<std::size_t, 4> spine{0, 3, 1, 2}, wings{4, 5, 4, 5};
  for (std::size_t k = 0; k < 4; ++k) {
    add(layout.spine[k], sides[spine[k]]);
    add(layout.wings[k], sides[wings[k]]);
  }
  add(layout.ruler, {200, 60});
  add(layout.legend, {420, 90});
  for (std::size_t a = 0; a < placed.size(); ++a) {
    EXPECT_GE(placed[a].x0, 100 - 1);
    EXPECT_GE(placed[a].y0, 100);
    EXPECT_LE(placed[a].x1, layout.width - 99);
    EXPECT_LE(placed[a].y1, layout.height - 100);
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_TRUE(placed[a].x1 <= placed[b].x0 || placed[b].x1 <= placed[a].x0 || placed[a].y1 <= placed[b].y0 ||
                  placed[b].y1 <= placed[a].y0)
          << a << " covers " << b;
  }
  EXPECT_TRUE(layout.wings[2].half_turned && layout.wings[3].half_turned);
  EXPECT_LT(layout.wings[0].x, layout.spine[0].x);
  EXPECT_LT(layout.wings[2].x, layout.spine[2].x);
}

TEST(FatCross, TheRulerIsTheLongestThatIsNotLongerThanTheTablet) {
  EXPECT_EQ(ruler_length_mm(8.0), 10);
  EXPECT_EQ(ruler_length_mm(19.9), 10);
  EXPECT_EQ(ruler_length_mm(20.0), 20);
  EXPECT_EQ(ruler_length_mm(61.0), 50);
}

/// How many pixels of these rows have exactly this colour.
int count_of(const Image& image, const Rgb8& color, int from_row) {
  int out = 0;
  for (int y = from_row; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) out += std::equal(color.begin(), color.end(), image.at(x, y)) ? 1 : 0;
  return out;
}

TEST(FatCross, AStyleThatTellsAFigureHasItsScaleBelowTheRulerAndTheHatchItsMeaning) {
  SilentProgress progress;
  TriMesh mesh = box(40.0, 30.0, 12.0);
  mesh.triangle_inferred.assign(mesh.triangles.size(), 0);
  mesh.triangle_inferred[2] = 1;
  const auto font = LabelFont::create(panel_font()).value();
  FatCrossOptions options;
  options.dpi = 300.0;
  options.shading = shading_preset("mean-curvature").value();
  const Style& style = options.shading.style;
  for (const Rgb8& ground : {Rgb8{255, 255, 255}, Rgb8{0, 0, 0}}) {
    options.ground = ground;
    options.legend = {};
    const auto without = draw_fat_cross(mesh, options, progress);
    options.legend = {font.get(), 600.0, 0.147};
    const auto with = draw_fat_cross(mesh, options, progress);
    ASSERT_TRUE(without && with);
    const Image &sheet = with->whole, &plain = without->whole;
    ASSERT_EQ(sheet.width, plain.width);
    ASSERT_GT(sheet.height, plain.height + options.gap_px);
    const auto same = static_cast<std::ptrdiff_t>(plain.pixels.size());
    EXPECT_TRUE(std::equal(plain.pixels.begin(), plain.pixels.begin() + same, sheet.pixels.begin()))
        << "all that stood there stands there still";
    // The bar: 13 letters of 2.5 mm long, its colours in their order.
    const auto colors = field_colors(style);
    const int letter = static_cast<int>(std::lround(2.5 / 25.4 * 300.0));
    int rows = 0;
    for (int y = plain.height; y < sheet.height; ++y) {
      std::vector<int> at;
      for (int x = 0; x < sheet.width; ++x)
        if (std::equal(colors[0].begin(), colors[0].end(), sheet.at(x, y))) at.push_back(x);
      if (at.empty() || at.front() + 13 * letter > sheet.width) continue;
      bool bar = true;
      for (const double part : {0.25, 0.5, 0.75, 0.995})
        for (int c = 0; c < 3; ++c)
          bar = bar &&
                std::abs(sheet.at(at.front() + static_cast<int>(part * 13 * letter), y)[c] -
                         colors[static_cast<std::size_t>(std::lround(part * 127))][static_cast<std::size_t>(c)]) < 10;
      rows += bar ? 1 : 0;
    }
    EXPECT_NEAR(rows, 0.8 * letter, 2);
    EXPECT_GT(count_of(sheet, style.hatch.ground, plain.height), letter * letter);
    EXPECT_GT(count_of(sheet, style.hatch.stripe, plain.height), letter * letter);
    const Rgb8 ink = ground[0] == 0 ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0};
    EXPECT_GT(count_of(sheet, ink, plain.height), letter * letter) << "words";
  }
}

TEST(FatCross, SheetsOfSeveralStylesAreAsLargeAndAPlainOneHasNoLegend) {
  SilentProgress progress;
  const auto font = LabelFont::create(panel_font()).value();
  FatCrossOptions options;
  options.dpi = 150.0;
  const auto height = [&](const char* style, bool room) {
    options.shading = shading_preset(style).value();
    options.legend = {font.get(), 0.0, 0.0, room};
    return draw_fat_cross(box(20.0, 30.0, 12.0), options, progress).value().whole.height;
  };
  EXPECT_EQ(height("phong", true), height("msii", true));
  EXPECT_LT(height("phong", false), height("phong", true));
  options.legend = {};
  options.shading = shading_preset("phong").value();
  EXPECT_EQ(draw_fat_cross(box(20.0, 30.0, 12.0), options, progress).value().whole.height, height("phong", false));
}

TEST(FatCross, FilesSayTheirScaleAndWhoseTheyAre) {
  const fs::path file = fs::temp_directory_path() / fmt::format("dubsar_cross_{}.tif", ::getpid());
  const std::string xmp = xmp_packet({"AO 8295 <loan> & seal", "CC BY 4.0",
                                      "Mus\xc3\xa9"
                                      "e du Louvre",
                                      "dubsar"});
  EXPECT_THAT(xmp, HasSubstr("AO 8295 &lt;loan&gt; &amp; seal"));
  ASSERT_TRUE(write_tiff(file, Image(30, 20, 3), 600.0, {"AO 8295", "CC BY 4.0", xmp}));
  const auto text = [&] {
    std::string bytes(static_cast<std::size_t>(fs::file_size(file)), '\0');
    FILE* const in = std::fopen(file.c_str(), "rb");
    EXPECT_EQ(std::fread(bytes.data(), 1, bytes.size(), in), bytes.size());
    std::fclose(in);
    return bytes;
  }();
  EXPECT_THAT(text, HasSubstr("CC BY 4.0"));
  EXPECT_THAT(text, HasSubstr("Mus\xc3\xa9"
                              "e du Louvre"));
  auto tiff = TiffFile::open(file);
  ASSERT_TRUE(tiff);
  const auto page = tiff->select(0);
  ASSERT_TRUE(page);
  EXPECT_EQ(page->resolution.x_per_unit, 600.0);
  EXPECT_EQ(page->resolution.unit_mm, 25.4);
  EXPECT_EQ(page->texts.description, "AO 8295");
  fs::remove(file);
}

TEST(FatCross, ResolutionsThatMakeNoSenseAreRefused) {
  SilentProgress progress;
  FatCrossOptions options;
  options.dpi = 0.0;
  const auto cross = draw_fat_cross(box(10, 10, 10), options, progress);
  ASSERT_FALSE(cross);
  EXPECT_EQ(cross.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar::app
