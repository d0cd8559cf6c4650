// Labels: where their letters stand, that they are sharp at every size, and what hides them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <memory>
#include <set>
#include <vector>

#include "display/render/context/context_egl.h"
#include "display/render/images/label_font.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/renderer.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr int kLabelSide = 200;  // pixels; one mm each

class Labels : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
    renderer_ = Renderer::create().value();
    std::ifstream file(DUBSAR_PANEL_FONT, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
    font_ = LabelFont::create(bytes_).value();
    label_.font = font_.get();
    label_.color = {255, 255, 255};
    label_.border = {0, 0, 255};
  }
  Image picture(std::span<const DrawItem> items, int factor = 1) {
    View view;
    view.clip_from_view = glm::ortho(-100.0, 100.0, -100.0, 100.0, -100.0, 100.0);
    const SceneView scene{items, Light(), {}, Background{{0, 0, 0}, false}};
    auto array = ViewArray::create(kLabelSide, kLabelSide, 3).value();
    const std::array<View, 2> eyes{view, view};
    const std::array<int, 2> where{2, 0};
    EXPECT_TRUE(renderer_.render_layers(scene, eyes, where, array));
    const Image layered = array.read_layer(2).value();
    const auto drawn = renderer_.render(scene, std::span(&view, 1), factor, array);
    EXPECT_TRUE(drawn) << drawn.error().message;
    Image out = array.read_layer(0).value();
    int off = 0;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) off += std::abs(out.pixels[i] - layered.pixels[i]) > 2;
    if (factor == 1) {
      EXPECT_EQ(off, 0) << "in layers as alone";
    }
    return out;
  }
  struct Extent {
    int left = kLabelSide, right = -1, top = kLabelSide, bottom = -1, count = 0;
  };
  /// Of pixels that `wanted` says yes to.
  template <class Wanted>
  static Extent extent(const Image& image, const Wanted& wanted) {
    Extent out;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (wanted(image.at(x, y))) {
          out = {std::min(out.left, x), std::max(out.right, x), std::min(out.top, y), std::max(out.bottom, y),
                 out.count + 1};
        }
    return out;
  }
  static bool white(const std::uint8_t* p) { return p[0] > 200; }
  static bool drawn(const std::uint8_t* p) { return p[2] > 60; }

  std::unique_ptr<EglContext> context_;
  Renderer renderer_;
  std::vector<unsigned char> bytes_;
  std::unique_ptr<LabelFont> font_;
  LabelItem label_;
};

TEST_F(Labels, StandWhereTheyBeginAndAreAsHighAsTheyShallBe) {
  label_.text = "HH";
  label_.at_mm = {-30, 10, 0};
  label_.height_px = 40;
  const std::array<DrawItem, 1> items{label_};
  const Extent seen = extent(picture(items, 2), white);
  EXPECT_NEAR(seen.left, 70 + 3, 3) << "at x = -30, behind the letter's own room";
  EXPECT_NEAR(seen.bottom, 90 - 1, 2) << "stands on y = 10";
  EXPECT_NEAR(seen.bottom - seen.top, 0.52 * 40, 5) << "capitals of Latin fonts are .6 to .75 of an em of letters";
  label_.anchor = 1.0;
  const std::array<DrawItem, 1> ends{label_};
  EXPECT_NEAR(extent(picture(ends, 2), white).right, 70 - 3, 3);
  label_.anchor = 0.0;
  label_.along_mm = {0, 10, 0};  // upwards
  const std::array<DrawItem, 1> up{label_};
  const Extent turned = extent(picture(up, 2), white);
  EXPECT_NEAR(turned.bottom - turned.top, seen.right - seen.left, 2);
  EXPECT_NEAR(turned.right, 70 - 1, 2);
}

TEST_F(Labels, AreSharpAtEverySizeAndHaveABorder) {
  label_.text = "I";
  for (const double height : {12.0, 24.0, 48.0, 120.0}) {
    label_.height_px = height;
    label_.at_mm = {-20.5, -40, 0};
    const std::array<DrawItem, 1> items{label_};
    const Image image = picture(items);
    const Extent seen = extent(image, white), all = extent(image, drawn);
    ASSERT_GT(seen.count, 0) << height;
    // Across the stem: nothing, border, white, border, nothing, each step within a pixel and a half.
    const int y = (seen.top + seen.bottom) / 2;
    int between = 0, whites = 0, blues = 0;
    for (int x = 0; x < kLabelSide; ++x) {
      const std::uint8_t* const p = image.at(x, y);
      whites += p[0] > 230;
      blues += p[2] > 230 && p[0] < 25;
      between += (p[0] >= 25 && p[0] <= 230) || (p[2] >= 25 && p[2] <= 230);
    }
    EXPECT_GE(whites, 1) << height;
    EXPECT_LE(between, 6) << height;
    if (height >= 48) {
      EXPECT_GE(blues, 2) << height;
    }
    EXPECT_LT(all.left, seen.left);
    EXPECT_GT(all.right, seen.right);
  }
}

TEST_F(Labels, AreHiddenByWhatStandsBeforeThemAndNotByWhatTheyStandOn) {
  TriMesh wall;
  testing::add_rectangle(wall, {-90, -90, 0}, {180, 0, 0}, {0, 180, 0}, 0);
  const LodMesh mesh = LodMesh::exact(pack_mesh(wall).value()).value();
  MeshItem plate{&mesh, glm::dmat4(1.0), shading_preset("ao").value().style, {}};
  plate.parts[0].color = {0, 0, 0};
  label_.text = "MM";
  label_.height_px = 40;
  const auto whites = [&](double z, double hidden) {
    label_.at_mm = {-20, 0, z};
    label_.hidden_opacity = hidden;
    const std::array<DrawItem, 2> items{plate, label_};
    return extent(picture(items), white).count;
  };
  const int free = whites(20, 0);
  EXPECT_GT(free, 100);
  EXPECT_EQ(whites(0, 0), free) << "on the surface";
  EXPECT_EQ(whites(-2, 0), free) << "in a hollow of it";
  EXPECT_EQ(whites(-10, 0), 0) << "behind it";
  EXPECT_EQ(whites(-10, 1), free);
}

// A wall over the left half of the picture, and labels that run from one half into the other.
TEST_F(Labels, AreReadAsAWholeOrNotAtAll) {
  TriMesh wall;
  testing::add_rectangle(wall, {-90, -90, 0}, {90, 0, 0}, {0, 180, 0}, 0);
  const LodMesh mesh = LodMesh::exact(pack_mesh(wall).value()).value();
  MeshItem plate{&mesh, glm::dmat4(1.0), shading_preset("ao").value().style, {}};
  plate.parts[0].color = {0, 0, 0};
  label_.text = "MMMM";
  label_.height_px = 30;
  const auto whites = [&](double x, double anchor, double hidden) {
    label_.at_mm = {x, 0, -20};  // behind the wall
    label_.anchor = anchor;
    label_.hidden_opacity = hidden;
    const std::array<DrawItem, 2> items{plate, label_};
    return extent(picture(items), white).count;
  };
  const int whole = whites(10, 0, 0);
  EXPECT_GT(whole, 400) << "nothing is before it";
  EXPECT_EQ(whites(-40, 0, 0), 0) << "its place is hidden, half of its letters would not be";
  EXPECT_NEAR(whites(40, 1, 0), whole, 0.1 * whole) << "its place is seen, half of its letters would not be";
  EXPECT_NEAR(whites(-40, 0, 1), whole, 0.1 * whole) << "wanted also where it is hidden";
  // Its place goes behind the wall by a tenth of a pixel a step: it fades, and nothing jumps.
  std::vector<int> light;
  for (int step = 0; step <= 120; ++step) {
    label_.at_mm = {6.0 - 0.1 * step, 0, -20};
    label_.anchor = 0.0;
    label_.hidden_opacity = 0.0;
    const std::array<DrawItem, 2> items{plate, label_};
    const Image image = picture(items);
    int brightest = 0;
    for (int y = 0; y < kLabelSide; ++y)
      for (int x = 0; x < kLabelSide; ++x) brightest = std::max<int>(brightest, image.at(x, y)[0]);
    light.push_back(brightest);
  }
  EXPECT_GT(light.front(), 240);
  EXPECT_EQ(light.back(), 0);
  EXPECT_TRUE(std::is_sorted(light.rbegin(), light.rend()));
  EXPECT_GE(std::set<int>(light.begin(), light.end()).size(), 4u) << "in steps between";
}

TEST_F(Labels, EachViewDecidesForItself) {
  TriMesh wall;
  testing::add_rectangle(wall, {-90, -90, 0}, {85, 0, 0}, {0, 180, 0}, 0);  // up to x = -5
  const LodMesh mesh = LodMesh::exact(pack_mesh(wall).value()).value();
  MeshItem plate{&mesh, glm::dmat4(1.0), shading_preset("ao").value().style, {}};
  plate.parts[0].color = {0, 0, 0};
  label_.text = "MM";
  label_.height_px = 30;
  label_.at_mm = {-10, 0, -40};
  const std::array<DrawItem, 2> items{plate, label_};
  std::array<View, 2> eyes;
  for (int eye = 0; eye < 2; ++eye) {  // sheared by half a millimetre a millimetre of depth, to either side
    glm::dmat4 shear(1.0);
    shear[2][0] = eye == 0 ? 0.5 : -0.5;
    eyes[eye].clip_from_view = glm::ortho(-100.0, 100.0, -100.0, 100.0, -100.0, 100.0) * shear;
  }
  const SceneView scene{items, Light(), {}, Background{{0, 0, 0}, false}};
  auto array = ViewArray::create(kLabelSide, kLabelSide, 2).value();
  const std::array<int, 2> where{0, 1};
  ASSERT_TRUE(renderer_.render_layers(scene, eyes, where, array));
  EXPECT_EQ(extent(array.read_layer(0).value(), white).count, 0) << "seen 20 mm farther left: behind the wall";
  EXPECT_GT(extent(array.read_layer(1).value(), white).count, 100) << "20 mm farther right: beside it";
}

TEST_F(Labels, OneViewDecidesForAllWhereThereIsAJudge) {
  TriMesh wall;
  testing::add_rectangle(wall, {-90, -90, 0}, {85, 0, 0}, {0, 180, 0}, 0);  // up to x = -5
  const LodMesh mesh = LodMesh::exact(pack_mesh(wall).value()).value();
  MeshItem plate{&mesh, glm::dmat4(1.0), shading_preset("ao").value().style, {}};
  plate.parts[0].color = {0, 0, 0};
  label_.text = "MM";
  label_.height_px = 30;
  std::array<View, 3> eyes;  // the last one from between the others
  for (int eye = 0; eye < 3; ++eye) {
    glm::dmat4 shear(1.0);
    shear[2][0] = eye == 0 ? 0.5 : eye == 1 ? -0.5 : 0.0;
    eyes[eye].clip_from_view = glm::ortho(-100.0, 100.0, -100.0, 100.0, -100.0, 100.0) * shear;
  }
  const std::span<const View> both(eyes.data(), 2);
  auto array = ViewArray::create(kLabelSide, kLabelSide, 2).value();
  const std::array<int, 2> where{0, 1};
  const auto counts = [&](double x, bool layered) {
    label_.at_mm = {x, 0, -40};
    const std::array<DrawItem, 2> items{plate, label_};
    SceneView scene{items, Light(), {}, Background{{0, 0, 0}, false}};
    scene.judge = &eyes[2];
    EXPECT_TRUE(layered ? renderer_.render_layers(scene, both, where, array) : renderer_.render(scene, both, 1, array));
    return std::pair(extent(array.read_layer(0).value(), white).count,
                     extent(array.read_layer(1).value(), white).count);
  };
  for (const bool layered : {true, false}) {
    EXPECT_EQ(counts(-15, layered), std::pair(0, 0)) << "the right eye alone sees it";
    const auto seen = counts(5, layered);  // the left eye does not
    EXPECT_GT(seen.first, 100);
    EXPECT_NEAR(seen.first, seen.second, 10) << "but for where pixels begin";
  }
}

TEST_F(Labels, HaveTheLettersOfTransliterationsAndSurviveAFullSheet) {
  EXPECT_GT(font_->width_em("\u0161\u1e63\u1e6d\u1e2b\u02be\u2082"), 2.0);
  for (const unsigned code : {0x161u, 0x1e63u, 0x1e6du, 0x1e2bu, 0x2beu, 0x2082u})
    EXPECT_GT(font_->glyph(code).width, 0) << std::hex << code;
  EXPECT_EQ(font_->glyph(' ').width, 0);
  label_.text = "A";
  label_.height_px = 60;
  const std::array<DrawItem, 1> items{label_};
  const Image before = picture(items);
  for (unsigned code = 0x21; code < 0x600; ++code) font_->glyph(code);
  EXPECT_EQ(picture(items).pixels, before.pixels);
}

TEST_F(Labels, WhatIsNoFontOrCannotBeDrawnIsRefused) {
  const std::vector<unsigned char> rubbish(1000, 'x');
  EXPECT_EQ(LabelFont::create(rubbish).error().kind, ErrorKind::kBadData);
  EXPECT_FALSE(LabelFont::create({}));
  const auto refused = [&](auto change) {
    LabelItem item = label_;
    item.text = "x";
    change(item);
    const std::array<DrawItem, 1> items{item};
    return !check_scene({items, Light(), {}, Background()}).has_value();
  };
  EXPECT_FALSE(refused([](LabelItem&) {}));
  EXPECT_TRUE(refused([](LabelItem& l) { l.font = nullptr; }));
  EXPECT_TRUE(refused([](LabelItem& l) { l.height_px = 0; }));
  EXPECT_TRUE(refused([](LabelItem& l) { l.opacity = 2; }));
  EXPECT_TRUE(refused([](LabelItem& l) { l.at_mm.x = std::nan(""); }));
}

double luminance(const std::uint8_t* p) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(p[0] / 255.0) + 0.7152 * linear(p[1] / 255.0) + 0.0722 * linear(p[2] / 255.0);
}

// Contrast as of WCAG 2.2: (L1 + .05) / (L2 + .05). On clay that is lit, on white and on black.
TEST_F(Labels, OnTheirGroundAreReadWhateverLiesBehind) {
  for (const std::array<std::uint8_t, 3> ground : std::vector<std::array<std::uint8_t, 3>>{
           {190, 180, 166}, {255, 255, 255}, {0, 0, 0}, {244, 240, 232}, {232, 180, 76}})
    for (const Rgb8 color : {Rgb8{0xe8, 0xb4, 0x4c}, Rgb8{0xf4, 0xf0, 0xe8}}) {
      label_.text = "IGI";
      label_.at_mm = {-60, 0, 0};
      label_.height_px = 30;
      label_.color = color;
      label_.border = {23, 24, 27};
      label_.plate = 0.94;
      View view;
      view.clip_from_view = glm::ortho(-100.0, 100.0, -100.0, 100.0, -100.0, 100.0);
      const std::array<DrawItem, 1> items{label_};
      const SceneView scene{items, Light(), {}, Background{{ground[0], ground[1], ground[2]}, false}};
      auto array = ViewArray::create(kLabelSide, kLabelSide, 1).value();
      ASSERT_TRUE(renderer_.render(scene, std::span(&view, 1), 1, array));
      const Image image = array.read_layer(0).value();
      // Of the plate: columns beside the first letter's stem, half an em above the base line.
      double bright = 0.0, dark = 1.0;
      for (int y = 100 - 18; y < 100 - 3; ++y)
        for (int x = 40; x < 75; ++x) {
          bright = std::max(bright, luminance(image.at(x, y)));
          dark = std::min(dark, luminance(image.at(x, y)));
        }
      const double between = luminance(image.at(40 - 3, 100 - 10));  // the ground's own border, before the letters
      EXPECT_GE((bright + 0.05) / (between + 0.05), 4.5) << int{ground[0]} << " " << int{color[2]};
      EXPECT_GE((bright + 0.05) / (dark + 0.05), 4.5);
      EXPECT_EQ(image.at(150, 100)[0], ground[0]) << "no farther than the text";
    }
}

}  // namespace
}  // namespace dubsar
