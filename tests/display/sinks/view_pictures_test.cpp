// Pictures that exist already, on displays: which view each eye sees, by the simulated eye.

#include "display/sinks/view_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "display/optics/srgb.h"
#include "display/sinks/quilt.h"
#include "display/sinks/render_display.h"
#include "tests/display/spec.h"

namespace dubsar {
namespace {

using Kind = PictureLayout::Kind;

TEST(PictureLayout, IsWhatTheNameSays) {
  const struct {
    const char* name;
    PictureLayout expected;
  } cases[] = {
      {"tablet.png", {}},
      {"sbs.png", {}},  // what it is called, not what is in it
      {"tablet_sbs.png", {.kind = Kind::kSideBySide}},
      {"a/b_tb/tablet_SBS_half.JPG", {.kind = Kind::kSideBySide, .half = true}},
      {"tablet_half_sbs.jpg", {.kind = Kind::kSideBySide, .half = true}},
      {"tablet.hsbs.tif", {.kind = Kind::kSideBySide, .half = true}},
      {"tablet-rl.png", {.kind = Kind::kSideBySide, .right_first = true}},
      {"tablet_tb.tiff", {.kind = Kind::kTopBottom}},
      {"tablet_hou_old.png", {.kind = Kind::kTopBottom, .half = true}},
      {"tablet_half.png", {}},
      {"tablet.jps", {.kind = Kind::kSideBySide, .right_first = true}},  // cross-eyed
      {"a_b.PNS", {.kind = Kind::kSideBySide, .right_first = true}},
      {"tablet_lr.jps", {.kind = Kind::kSideBySide}},
      {"tablet_qs8x6a0.75.png", {.kind = Kind::kQuilt, .columns = 8, .rows = 6, .aspect = 0.75}},
      {"tablet_QS5x9.png", {.kind = Kind::kQuilt, .columns = 5, .rows = 9}},
  };
  for (const auto& c : cases) EXPECT_EQ(layout_of_name(c.name), c.expected) << c.name;
  EXPECT_EQ(parse_picture_layout("sbs,half"), (PictureLayout{.kind = Kind::kSideBySide, .half = true}));
  EXPECT_EQ(parse_picture_layout("qs4x3a1.5"),
            (PictureLayout{.kind = Kind::kQuilt, .columns = 4, .rows = 3, .aspect = 1.5}));
  EXPECT_EQ(parse_picture_layout("plain"), PictureLayout{});
  for (const char* bad : {"", "half", "sbs,", "sideways", "qs0x3", "qs4x3,half"})
    EXPECT_FALSE(parse_picture_layout(bad)) << bad;
}

Image plain(int width, int height, const Rgb8& color) {
  Image out(width, height, 3);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = color[i % 3];
  return out;
}

constexpr Rgb8 kRed{220, 30, 30}, kBlue{30, 60, 220};

TEST(PictureLayout, PairsAreCutWhereTheyMeet) {
  Image picture = plain(41, 20, kRed);  // an odd width: a spare column between the two
  for (int y = 0; y < 20; ++y)
    for (int x = 21; x < 41; ++x) std::copy_n(kBlue.data(), 3, picture.at(x, y));
  const auto full = split_picture(picture, {.kind = Kind::kSideBySide});
  ASSERT_TRUE(full);
  EXPECT_DOUBLE_EQ(full->aspect, 1.0);
  EXPECT_EQ(full->views[0].pixels, plain(20, 20, kRed).pixels);
  EXPECT_EQ(full->views[1].pixels, plain(20, 20, kBlue).pixels);
  const auto half = split_picture(picture, {.kind = Kind::kSideBySide, .half = true, .right_first = true});
  ASSERT_TRUE(half);
  EXPECT_DOUBLE_EQ(half->aspect, 2.0);
  EXPECT_EQ(half->views[0].pixels, plain(20, 20, kBlue).pixels);
  EXPECT_EQ(split_picture(picture, {.kind = Kind::kQuilt, .columns = 9, .rows = 2}).error().kind, ErrorKind::kBadData);
}

TEST(PictureLayer, OneThatFitsIsCopiedAndAnotherShapeGetsBlackBeside) {
  Image noise(40, 30, 3);
  std::uint32_t state = 5;
  for (auto& value : noise.pixels) value = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  SinkTraits traits{.name = "made", .views = 1, .view = {40, 30}, .output = {400, 300}};
  const Image same = layer_of_picture(noise, 4.0 / 3, traits, 0);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(same.at(x, y)[c], noise.at(x, y)[c]);
  const Image tall = layer_of_picture(plain(15, 30, kRed), 0.5, traits, 0);  // 15 of the 40 columns
  for (int x = 0; x < 40; ++x)
    EXPECT_EQ(tall.at(x, 15)[0], x >= 13 && x < 27 ? 220 : x == 12 || x == 27 ? tall.at(x, 15)[0] : 0) << x;
  traits.aspect = 0.5;  // a tile whose pixels are not square on the panel
  EXPECT_EQ(layer_of_picture(plain(15, 30, kRed), 0.5, traits, 0).at(0, 0)[0], 220);
}

TEST(PictureLayer, FocusMovesTheOuterViewsAgainstEachOther) {
  Image line(100, 4, 3);
  for (int y = 0; y < 4; ++y) std::fill_n(line.at(50, y), 3, std::uint8_t{255});
  SinkTraits traits{.name = "made", .views = 5, .view = {100, 4}, .output = {100, 4}, .focus = {0.125, 1.0}};
  const auto bright = [&](int layer) {
    const Image out = layer_of_picture(line, 25.0, traits, layer);
    int best = 0;
    for (int x = 0; x < 100; ++x)
      if (out.at(x, 1)[0] > out.at(best, 1)[0]) best = x;
    return best;
  };
  EXPECT_EQ(bright(2), 50);
  EXPECT_EQ(bright(0), 60) << "the leftmost view, by 4/5 of the focus";
  EXPECT_EQ(bright(4), 40);
}

/// Grey steps: a mixture of neighbours is seen as what lies between them.
ViewPictures ramp(int count) {
  ViewPictures out;
  for (int i = 0; i < count; ++i) {
    const std::uint8_t grey = srgb_from_linear((i + 1.0) / (count + 1.0));
    out.views.push_back(plain(16, 9, {grey, grey, grey}));
  }
  out.aspect = 16.0 / 9;
  return out;
}

/// Linear light that an eye gets from the middle of the panel.
glm::dvec3 seen_light(const DisplayPicture& picture, const glm::dvec3& eye) {
  const Image seen = see_display(picture, eye).value();
  glm::dvec3 sum(0.0);
  int count = 0;
  for (int y = seen.height / 3; y < 2 * seen.height / 3; y += 7)
    for (int x = seen.width / 3; x < 2 * seen.width / 3; ++x, ++count)
      for (int c = 0; c < 3; ++c) sum[c] += linear_from_srgb(seen.at(x, y)[c]);
  return sum / static_cast<double>(count);
}

PanelProfile small(const char* name, int width, int height) {
  PanelProfile out = built_in_panels().find(name).value();
  out.width_mm *= static_cast<double>(width) / out.width_px;
  out.width_px = width, out.height_px = height;
  if (out.sheet) out.sheet->screen_width = width, out.sheet->screen_height = height;
  out.name = "small";
  return out;
}

Result<DisplayPicture> show_small(const ViewPictures& pictures, const PanelProfile& panel, const std::string& more = "",
                                  const DisplayOptions& given = {}) {
  DisplayOptions options = given;
  options.catalog = std::make_shared<SinkCatalog>();
  options.catalog->put(panel);
  return show_pictures(pictures, testing::spec("lenticular:small" + more), options);
}

TEST(ShownPictures, OfAPairEachEyeSeesItsOwnOnATrackedPanel) {
  const ViewPictures pair{.views = {plain(16, 9, kRed), plain(16, 9, kBlue)}, .aspect = 16.0 / 9};
  const PanelProfile panel = small("spatiallabs-15.6", 480, 270);
  DisplayOptions options;
  options.viewer.left_mm = {-11.5, 20, 590};
  options.viewer.right_mm = {51.5, 20, 590};
  for (const bool swapped : {false, true}) {
    for (const bool by_option : {false, true}) {
      options.viewer.swap_eyes = swapped && !by_option;
      const auto shown = show_small(pair, panel, swapped && by_option ? ",right_first" : "", options);
      ASSERT_TRUE(shown) << shown.error().message;
      const glm::dvec3 left = seen_light(*shown, options.viewer.left_mm),
                       right = seen_light(*shown, options.viewer.right_mm);
      // A little of the other eye's: at most 6 %.
      const auto expected = [&](bool red) { return red ? linear_from_srgb(220) : linear_from_srgb(30); };
      EXPECT_NEAR(left.r, expected(!swapped), 0.06 * linear_from_srgb(220)) << swapped << by_option;
      EXPECT_NEAR(right.r, expected(swapped), 0.06 * linear_from_srgb(220)) << swapped << by_option;
    }
  }
}

TEST(ShownPictures, OfAQuiltEachPlaceBeforeTheGlassSeesItsView) {
  const PanelProfile panel = small("looking-glass-portrait", 480, 120);
  const auto shown = show_small(ramp(48), panel, ",nearest");
  ASSERT_TRUE(shown) << shown.error().message;
  EXPECT_EQ(shown->views, 48);
  const double z = viewing_distance_mm(panel), half_cone = 0.5 * panel.zone.cone_deg * std::numbers::pi / 180;
  for (const int view : {6, 15, 24, 33, 41}) {
    const double across = 2 * (view + 0.5) / 48 - 1;
    const double light = seen_light(*shown, {z * across * std::tan(half_cone), 0, z}).g;
    EXPECT_NEAR(light * 49 - 1, view, 1.5) << "view " << view;
  }
}

TEST(ShownPictures, OfAPairALensSheetSendsTheLeftOneToTheLeft) {
  ViewPictures pair = ramp(2);
  pair.aspect = 400.0 / 60;
  const PanelProfile panel = small("lens-sheet-24-5-views", 400, 60);
  const auto shown = show_small(pair, panel, ",nearest");
  ASSERT_TRUE(shown) << shown.error().message;
  const double z = viewing_distance_mm(panel), half_cone = 0.5 * panel.zone.cone_deg * std::numbers::pi / 180;
  EXPECT_NEAR(seen_light(*shown, {-0.5 * z * std::tan(half_cone), 0, z}).g, 1.0 / 3, 0.03);
  EXPECT_NEAR(seen_light(*shown, {0.5 * z * std::tan(half_cone), 0, z}).g, 2.0 / 3, 0.03);
}

TEST(ShownPictures, OfAQuiltTwoEyesGetTheViewsTheyWouldSeeFromThere) {
  ViewPictures quilt = ramp(40);
  quilt.cone_deg = 40;
  Observer viewer;
  const SinkTraits stereo{.name = "made", .views = 2, .view = {8, 8}, .output = {16, 8}};
  for (const double x : {-150.0, 0.0, 80.0}) {
    viewer.left_mm = {x - 31.5, 0, 600};
    viewer.right_mm = {x + 31.5, 0, 600};
    for (int eye = 0; eye < 2; ++eye) {
      const double degrees = std::atan((x + (eye == 0 ? -31.5 : 31.5)) / 600) * 180 / std::numbers::pi;
      EXPECT_EQ(picture_for_layer(quilt, stereo, eye, viewer), static_cast<int>(std::floor(degrees + 20)));
    }
  }
  viewer.left_mm.x = -900, viewer.right_mm.x = 900;
  EXPECT_EQ(picture_for_layer(quilt, stereo, 0, viewer), 0);
  EXPECT_EQ(picture_for_layer(quilt, stereo, 1, viewer), 39);
  EXPECT_EQ(picture_for_layer(quilt, {.name = "made", .views = 1}, 0, viewer), 20);
}

}  // namespace
}  // namespace dubsar
