// Looks of a surface against formulas: two mixed, ridges lifted out, figures told by colours.

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/files/atomic_file.h"
#include "core/relief/curvature/integral_invariants.h"
#include "display/optics/srgb.h"
#include "display/render/context/context_egl.h"
#include "display/render/images/legend_image.h"
#include "display/render/images/render_image.h"
#include "display/render/mesh/field_maker.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/renderer.h"
#include "tests/display/render/grown_mesh.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

constexpr int kLookSide = 240, kMiddle = kLookSide / 2, kThird = kLookSide / 3;
constexpr double kRadius = 2.0;

RenderOptions front(const Shading& shading) {
  RenderOptions options;
  options.shading = shading;
  options.camera.width = options.camera.height = kLookSide;
  options.camera.margin = 0.0;
  options.samples = 1;
  return options;
}

Image picture(const TriMesh& mesh, const Shading& shading) {
  SilentProgress silent;
  const auto made = render_picture(mesh, front(shading), silent);
  EXPECT_TRUE(made) << made.error().message;
  return made ? made->image : Image(1, 1, 3);
}

Shading preset(std::string_view name) { return shading_preset(name).value(); }

TriMesh ball() { return testing::sphere(static_cast<float>(kRadius), 180, 360); }

/// With grooves, so that light from aside casts shadows.
TriMesh grooved_ball() {
  TriMesh mesh = testing::sphere(2.0f, 60, 120);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.positions[v].z += 0.2f * std::sin(9.0f * mesh.positions[v].x);
  mesh.normals.clear();
  return mesh;
}

TEST(Blend, IsTheMeanOfBothInLinearLight) {
  const TriMesh mesh = grooved_ball();
  Shading both = preset("relief");
  both.light.elevation_deg = preset("raking").light.elevation_deg;  // both looks have one light's place
  const Image first = picture(mesh, both), second = picture(mesh, preset("raking"));
  both.other = {preset("raking").style, preset("raking").light, 0.3};
  const Image mixed = picture(mesh, both);
  int differing = 0;
  for (int y = 0; y < kLookSide; ++y)
    for (int x = 0; x < kLookSide; ++x)
      for (int c = 0; c < 3; ++c) {
        const double a = linear_from_srgb(first.at(x, y)[c]), b = linear_from_srgb(second.at(x, y)[c]);
        ASSERT_NEAR(mixed.at(x, y)[c], srgb_from_linear(0.7 * a + 0.3 * b), 1.5) << x << " " << y;
        differing += std::abs(first.at(x, y)[c] - second.at(x, y)[c]) > 20 ? 1 : 0;
      }
  EXPECT_GT(differing, 5000) << "two looks that differ";
  both.other.share = 0.0;
  EXPECT_EQ(picture(mesh, both).pixels, first.pixels);
  both.other.share = 1.0;
  EXPECT_EQ(picture(mesh, both).pixels, second.pixels);
  both.other.share = 1.1;
  SilentProgress silent;
  EXPECT_EQ(render_picture(mesh, front(both), silent).error().kind, ErrorKind::kUsage);
}

TEST(Blend, OfLooksWithAndWithoutLightShadowsAndHighlightsIsTheirMean) {
  const TriMesh mesh = grooved_ball();
  for (const auto& [one, two] :
       {std::pair{"ao", "raking"}, {"raking", "ao"}, {"table", "phong"}, {"raking", "phong"}}) {
    Shading both = preset(one), other = preset(two);
    other.light.elevation_deg = both.light.elevation_deg;
    both.other = {other.style, other.light, 0.5};
    const Image mixed = picture(mesh, both), second = picture(mesh, other);
    both.other.share = 0.0;
    const Image first = picture(mesh, both);
    int off = 0;
    for (int y = 0; y < kLookSide; ++y)
      for (int x = 0; x < kLookSide; ++x)
        for (int c = 0; c < 3; ++c) {
          const double a = linear_from_srgb(first.at(x, y)[c]), b = linear_from_srgb(second.at(x, y)[c]);
          off += std::abs(mixed.at(x, y)[c] - srgb_from_linear(0.5 * a + 0.5 * b)) > 1.5;
        }
    EXPECT_EQ(off, 0) << one << " and " << two;
  }
}

/// White clay that only a light from the eye falls on.
Shading plain_white() {
  Shading out = preset("phong");
  out.style.base_color = {255, 255, 255};
  out.light = {};
  out.light.elevation_deg = 90;
  out.light.ambient = out.light.fill = out.light.specular = 0;
  out.light.key = 1;
  return out;
}

/// Equation 2 of the paper, convex counted as negative, the point of invariance at 0.2.
double scaled(double bend, double d) {
  const double a = 0.2, e = std::exp(-bend);
  return d * (a * e + d * (1 - a - a * e)) / (a + d * (e - a - a * e));
}

TEST(RadianceScaling, OnABallIsTheFormulaOfThePaper) {
  for (const double strength : {0.5, 1.0, 2.0}) {
    Shading shading = plain_white();
    shading.style.radiance = strength;
    const Image image = picture(ball(), shading);
    // Mean curvature 1 / R; the bend is 2.5 tanh of half of it.
    const double bend = strength * 2.5 * std::tanh(0.5 / kRadius);
    for (int x = kLookSide / 2; x < kLookSide * 0.97; x += 5) {
      const double at = (x + 0.5 - kMiddle) / (kMiddle), facing = std::sqrt(1 - at * at);
      EXPECT_NEAR(image.at(x, kMiddle)[0], srgb_from_linear(scaled(bend, facing)), 2.5) << strength << " " << facing;
    }
  }
  EXPECT_NEAR(scaled(1.7, 0.2), 0.2, 1e-12) << "stays as it is";
  EXPECT_GT(scaled(1.0, 0.7), 0.7);
  EXPECT_LT(scaled(-1.0, 0.7), 0.7);
  EXPECT_LT(scaled(1.0, 0.1), 0.1);
}

TEST(RadianceScaling, LeavesPlanesAsTheyAreInEveryStyle) {
  TriMesh plate;
  testing::add_rectangle(plate, {-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 0);
  for (const std::string_view name : {"phong", "relief", "raking", "ao", "sky-sun"}) {
    Shading shading = preset(name);
    const Image before = picture(plate, shading);
    shading.style.radiance = 1.0;
    EXPECT_EQ(picture(plate, shading).pixels, before.pixels) << name;
  }
}

TEST(FigureColours, OnABallAreThoseOfItsCurvatures) {
  const double k = 1.0 / kRadius;
  const struct {
    const char* style;
    double figure;
  } cases[] = {{"mean-curvature", k}, {"gaussian-curvature", k * k}, {"shape-index", 1.0}, {"curvedness", k}};
  for (const auto& c : cases)
    for (const FieldColors colors : {FieldColors::kDesigned, FieldColors::kCividis, FieldColors::kGrey}) {
      Shading shading = preset(c.style);
      shading.style.field_colors = colors;
      shading.style.contrast = 1.5;
      const Image image = picture(ball(), shading);
      const Rgb8 expected = field_color(shading.style, c.figure);
      for (const int x : {kLookSide / 2, kLookSide * 2 / 3, kLookSide / 5})
        for (int channel = 0; channel < 3; ++channel)
          EXPECT_NEAR(image.at(x, kMiddle)[channel], expected[channel], 3) << c.style << " " << x;
    }
}

TEST(FigureColours, IntegralInvariantsAreThoseOfTheBallsCaps) {
  const TriMesh mesh = ball();
  const double radius = default_invariant_radius_mm(mesh);
  double square = 0.0;
  for (int s = 1; s <= 4; ++s) square += std::pow(3.0 * radius * s / 4.0 / (16.0 * kRadius), 2) / 4.0;
  Shading shading = preset("msii");
  const Image image = picture(mesh, shading);
  const Rgb8 expected = field_color(shading.style, std::sqrt(square));
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(image.at(kMiddle, kMiddle)[channel], expected[channel], 3);
  EXPECT_GT(expected[1], shading.style.base_color[1] + 4) << "convex is lighter than level clay";
}

TEST(FigureColours, ArithmeticOfTheFiguresIsThatOfTheBooks) {
  const auto carried = [](double low, double high) {
    return CarriedField{0, static_cast<std::int16_t>(std::lround(low / 32 * 32767)),
                        static_cast<std::int16_t>(std::lround(high / 32 * 32767)), 0};
  };
  EXPECT_NEAR(field_figure(ColorMap::kMean, carried(-1, 3)), 1.0, 1e-3);
  EXPECT_NEAR(field_figure(ColorMap::kGaussian, carried(-1, 3)), -3.0, 4e-3);
  EXPECT_NEAR(field_figure(ColorMap::kCurvedness, carried(-1, 3)), std::sqrt(5.0), 1e-3);
  EXPECT_NEAR(field_figure(ColorMap::kShapeIndex, carried(2, 2)), 1.0, 1e-6) << "cap";
  EXPECT_NEAR(field_figure(ColorMap::kShapeIndex, carried(0, 2)), 0.5, 1e-6) << "ridge";
  EXPECT_NEAR(field_figure(ColorMap::kShapeIndex, carried(-2, 2)), 0.0, 1e-6) << "saddle";
  EXPECT_NEAR(field_figure(ColorMap::kShapeIndex, carried(-2, 0)), -0.5, 1e-6) << "rut";
  EXPECT_NEAR(field_figure(ColorMap::kShapeIndex, carried(0, 0)), 0.0, 1e-6);
}

TEST(FigureColours, EndsOfTheScalesAreToldApartByEveryEye) {
  // H. Brettel, F. Vienot, J. Mollon, 1997, in the linear form of F. Vienot, 1999: what is left without red or green.
  const auto without = [](const Rgb8& c, bool red) {
    const double r = linear_from_srgb(c[0]), g = linear_from_srgb(c[1]), b = linear_from_srgb(c[2]);
    return red ? std::array{0.1121 * r + 0.8853 * g - 0.0005 * b, 0.1127 * r + 0.8897 * g - 0.0001 * b,
                            0.0045 * r + 0.0 * g + 1.0019 * b}
               : std::array{0.2920 * r + 0.7054 * g - 0.0003 * b, 0.2934 * r + 0.7089 * g + 0.0 * b,
                            -0.0210 * r + 0.0256 * g + 0.9921 * b};
  };
  for (const FieldColors colors : {FieldColors::kBlueOrange, FieldColors::kCividis, FieldColors::kGrey})
    for (const bool red : {false, true}) {
      Style style = preset("mean-curvature").style;
      style.field_colors = colors;
      const auto all = field_colors(style);
      const auto low = without(all.front(), red), high = without(all.back(), red);
      double apart = 0.0;
      for (std::size_t c = 0; c < 3; ++c)
        apart += std::pow(
            srgb_from_linear(std::clamp(low[c], 0.0, 1.0)) - srgb_from_linear(std::clamp(high[c], 0.0, 1.0)), 2);
      EXPECT_GT(std::sqrt(apart), 100.0) << static_cast<int>(colors) << " of 441 in sRGB";
    }
}

TEST(FigureColours, EveryLevelOfDetailCarriesThem) {
  const auto context = EglContext::create().value();
  const TriMesh mesh = ball();
  LodMesh levels = testing::grown_mesh(pack_mesh(mesh).value());
  SilentProgress progress;
  Shading shading = preset("mean-curvature");
  ASSERT_TRUE(carry_fields(levels, mesh, fields_needed(shading.style), progress));
  ASSERT_GT(levels.levels(), 2);
  auto renderer = Renderer::create().value();
  const Camera camera = fit_camera(levels.box_mm(), {.width = kLookSide, .height = kLookSide}).value();
  const Rgb8 expected = field_color(shading.style, 1.0 / kRadius);
  for (const double coarse : {0.0, 2.0, 4.0}) {
    auto array = ViewArray::create(kLookSide, kLookSide, 1).value();
    const int layer = 0;
    ASSERT_TRUE(renderer.render_layers(MeshScene(levels, shading), std::span(&camera.view, 1), std::span(&layer, 1),
                                       array, coarse));
    const Image image = array.read_layer(0).value();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(kMiddle, kThird)[c], expected[c], 3) << coarse;
  }
}

TEST(FigureColours, WhatWasMeasuredOnceIsNotMeasuredAgain) {
  struct Counting final : Progress {
    std::int64_t items = 0;
    void on_begin(std::string_view, std::int64_t total, std::string_view) override { items += total; }
    void on_advance(std::int64_t) override {}
  };
  const auto context = EglContext::create().value();
  const TriMesh mesh = testing::sphere(2.0f, 60, 120);
  LodMesh levels = LodMesh::exact(pack_mesh(mesh).value()).value();
  const auto work = [&](const FieldNeeds& needs) {
    Counting progress;
    EXPECT_TRUE(carry_fields(levels, mesh, needs, progress));
    return progress.items;
  };
  const std::int64_t integral = work({true, false}), curvature = work({false, true});
  EXPECT_EQ(work({true, true}), 0);
  LodMesh fresh = LodMesh::exact(pack_mesh(mesh).value()).value();
  std::swap(levels, fresh);
  EXPECT_EQ(work({true, true}), integral + curvature);
  EXPECT_EQ(levels.fields()->values, fresh.fields()->values);
  EXPECT_EQ(fresh.fields()->has, (FieldNeeds{true, true}));
}

TEST(FieldMaker, MakesWhatIsAskedForBesideAndStopsWhenItGoes) {
  const TriMesh mesh = testing::sphere(2.0f, 60, 120);
  SilentProgress progress;
  const FieldNeeds needs{true, true};
  const auto expected = measure_fields(mesh, needs, progress).value();
  FieldMaker maker(mesh, needs);
  std::optional<Result<SurfaceFields>> made;
  while (!(made = maker.take())) std::this_thread::yield();
  ASSERT_TRUE(*made);
  EXPECT_EQ((*made)->values, expected.values);
  EXPECT_EQ(maker.share(), 1.0);
  EXPECT_FALSE(maker.take()) << "once";
  const FieldMaker stopped(mesh, needs);
}

TEST(Legend, ShowsTheColoursAndTheirNumbers) {
  const std::string bytes = read_text_file(DUBSAR_PANEL_FONT).value();
  const auto font = LabelFont::create({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}).value();
  const Style style = preset("mean-curvature").style;
  const Image image = legend_image(style, *font, 20).value();
  const auto colors = field_colors(style);
  // The bar begins 2.7 letters from the left, below one line, and is 13 letters long.
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const int x = static_cast<int>(2.7 * 20 + part * (13 * 20 - 1));
    const auto& expected = colors[static_cast<std::size_t>(std::lround(part * 127))];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(x, static_cast<int>(2.3 * 20))[c], expected[c], 8) << part;
  }
  EXPECT_EQ(legend_image(preset("phong").style, *font, 20).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(legend_number(-0.0), "0");
  EXPECT_EQ(legend_number(2.5 / 1.5), "1.67");
  Style strong = style;
  strong.contrast = 2.0;
  EXPECT_EQ(field_scale(strong).to, 0.5 * field_scale(style).to) << "contrast brings the ends nearer";
}

}  // namespace
}  // namespace dubsar
