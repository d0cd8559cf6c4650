// Every sink's GL half against its CPU reference, on noise: any mistake in parity, order or place shows.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "core/image_io/png_file.h"
#include "display/optics/srgb.h"
#include "display/optics/weave.h"
#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/passes/compose_pass.h"
#include "display/render/renderer.h"
#include "display/render/view_array.h"
#include "display/sinks/anaglyph.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "display/sinks/interlaced.h"
#include "display/sinks/packed.h"
#include "display/sinks/quilt.h"
#include "tests/display/reference_pictures.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {
using testing::anaglyph_views;
using testing::interlace_views;
using testing::make_quilt;
using testing::pack_views;
using testing::row_light;
using testing::view_weights;
using testing::weave_tracked;
using testing::weave_views;

class SinksGl : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
  }

  /// Layers of noise for the sink, also as pictures.
  std::vector<Image> noise(const SinkTraits& traits) {
    std::vector<Image> views;
    for (int i = 0; i < traits.views; ++i) {
      Image image(traits.view.width, traits.view.height, 4);
      for (auto& value : image.pixels)
        value = static_cast<std::uint8_t>((state_ = state_ * 1664525u + 1013904223u) >> 24);
      views.push_back(std::move(image));
    }
    return views;
  }

  Image compose(OutputSink& sink, const std::vector<Image>& views) {
    const SinkTraits traits = sink.traits();
    auto array = ViewArray::create(traits.view.width, traits.view.height, traits.views);
    auto surface = OffscreenSurface::create(traits.output);
    EXPECT_TRUE(array && surface);
    for (int i = 0; i < traits.views; ++i) EXPECT_TRUE(array->write_layer(i, views[i]));
    const auto composed = sink.compose(*array, surface->surface());
    EXPECT_TRUE(composed) << composed.error().message;
    return surface->read().value();
  }

  std::unique_ptr<EglContext> context_;
  std::uint32_t state_ = 1;
};

TEST_F(SinksGl, MonoCopiesItsViewExactly) {
  auto sink = SinkCatalog().make("mono").value();
  ASSERT_TRUE(sink->configure({.window_w = 37, .window_h = 23}));
  const auto views = noise(sink->traits());
  const Image out = compose(*sink, views);
  for (int y = 0; y < 23; ++y)
    for (int x = 0; x < 37; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(out.at(x, y)[c], views[0].at(x, y)[c]);
}

TEST_F(SinksGl, AViewIsCopiedFromTheLowerLeftCornerAndWhatIsLargerIsBlackBesideIt) {
  auto sink = SinkCatalog().make("mono").value();
  ASSERT_TRUE(sink->configure({.window_w = 37, .window_h = 23}));
  const auto views = noise(sink->traits());
  auto array = ViewArray::create(37, 23, 2).value();
  ASSERT_TRUE(array.write_layer(1, views[0]));
  for (const PixelSize size : {PixelSize{37, 23}, {40, 23}, {37, 30}, {20, 10}}) {
    LayerCopy copy;
    auto surface = OffscreenSurface::create(size).value();
    ASSERT_TRUE(copy.draw(array, 1, surface.surface()));
    const Image out = surface.read().value();
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        for (int c = 0; c < 3; ++c) {
          const int row = y - size.height + 23;  // rows count from above
          ASSERT_EQ(out.at(x, y)[c], x < 37 && row >= 0 ? views[0].at(x, row)[c] : 0) << x << ", " << y;
        }
  }
}

TEST_F(SinksGl, PackedPicturesEqualTheReference) {
  const struct {
    const char* spec;
    Packing packing;
  } cases[] = {{"side_by_side", {}},
               {"side_by_side:full,right_first", {.full = true, .right_first = true}},
               {"top_bottom:right_first", {.vertical = true, .right_first = true}},
               {"top_bottom:full", {.vertical = true, .full = true}},
               {"top_bottom:frame_packing", {.vertical = true, .full = true, .frame_packing = true}}};
  for (const auto& c : cases)
    for (const PixelSize window : {PixelSize{64, 48}, {37, 25}}) {
      auto sink = SinkCatalog().make(c.spec).value();
      ASSERT_TRUE(sink->configure({.window_w = window.width, .window_h = window.height}));
      const auto views = noise(sink->traits());
      EXPECT_EQ(compose(*sink, views).pixels, pack_views(views[0], views[1], window, c.packing).pixels) << c.spec;
    }
}

TEST_F(SinksGl, InterlacedPicturesEqualTheReference) {
  const char* names[] = {"rows", "columns", "checkerboard", "subpixels"};
  for (int pattern = 0; pattern < 4; ++pattern)
    for (const bool right_first : {false, true})
      for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {0, 1}, {101, 54}, {-3, -2}}) {
        auto sink = SinkCatalog()
                        .make(std::string("interlaced:") + names[pattern] + (right_first ? ",right_first" : ""))
                        .value();
        const Screen screen{.window_x = x, .window_y = y, .window_w = 31, .window_h = 22};
        ASSERT_TRUE(sink->configure(screen));
        const auto views = noise(sink->traits());
        EXPECT_EQ(
            compose(*sink, views).pixels,
            interlace_views(views[0], views[1], screen, static_cast<InterlacePattern>(pattern), right_first).pixels)
            << names[pattern] << " at " << x << ", " << y;
      }
}

/// Bino takes the parity of gl_FragCoord, which counts from the screen's lower left corner.
TEST_F(SinksGl, RowsAndSquaresMayBeCountedFromTheBottom) {
  for (const char* pattern : {"rows", "checkerboard"})
    for (const int height : {1080, 1081}) {
      auto sink = SinkCatalog().make(std::string("interlaced:bottom,") + pattern).value();
      const Screen screen{.height_px = height, .window_x = 6, .window_y = 11, .window_w = 16, .window_h = 9};
      ASSERT_TRUE(sink->configure(screen));
      const auto views = noise(sink->traits());
      const Image out = compose(*sink, views);
      for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
          const int from_bottom = height - 1 - (screen.window_y + y), from_left = screen.window_x + x;
          const int eye = (from_bottom + (pattern[0] == 'c' ? from_left : 0)) % 2;
          ASSERT_EQ(out.at(x, y)[1], views[static_cast<std::size_t>(eye)].at(x, y)[1]) << pattern << " " << height;
        }
    }
  EXPECT_EQ(SinkCatalog().make("interlaced:columns,bottom").error().kind, ErrorKind::kUsage);
}

TEST_F(SinksGl, ExchangedEyesAreTheOtherViewsPicture) {
  for (const char* spec : {"anaglyph:amber_blue_half", "lenticular:small-tracked"}) {
    PanelSet panels = built_in_panels();
    PanelProfile small = panels.find("spatiallabs-15.6").value();
    small.name = "small-tracked", small.width_px = 120, small.height_px = 40, small.width_mm = 10.8;
    panels.put(small);
    Image pictures[2];
    for (const bool exchanged : {false, true}) {
      auto sink = SinkCatalog(panels).make(std::string(spec) + (exchanged ? ",right_first" : "")).value();
      ASSERT_TRUE(sink->configure({.window_w = 120, .window_h = 40}));
      sink->views(Observer());
      state_ = 7;
      auto views = noise(sink->traits());
      if (exchanged) std::swap(views[0], views[1]);
      pictures[exchanged] = compose(*sink, views);
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels) << spec;
  }
}

TEST_F(SinksGl, AnaglyphsEqualTheReferenceToOneStep) {
  for (const AnaglyphVariant& variant : anaglyph_variants()) {
    auto sink = SinkCatalog().make("anaglyph:" + std::string(variant.name)).value();
    ASSERT_TRUE(sink->configure({.window_w = 64, .window_h = 64}));
    const auto views = noise(sink->traits());
    const Image out = compose(*sink, views), expected = anaglyph_views(views[0], views[1], variant);
    int differ = 0;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
      ASSERT_NEAR(out.pixels[i], expected.pixels[i], 1) << variant.name;
      differ += out.pixels[i] != expected.pixels[i];
    }
    EXPECT_LE(differ, static_cast<int>(out.pixels.size() / 500)) << variant.name;
  }
}

TEST_F(SinksGl, QuiltsEqualTheReference) {
  for (const char* spec :
       {"quilt:columns=3,rows=2,width=61,height=43,aspect=1", "quilt:columns=5,rows=9,width=100,height=99"}) {
    auto sink = SinkCatalog().make(spec).value();
    ASSERT_TRUE(sink->configure({}));
    const SinkTraits traits = sink->traits();
    const auto views = noise(traits);
    const QuiltLayout layout{traits.views == 6 ? 3 : 5, traits.views == 6 ? 2 : 9, traits.output.width,
                             traits.output.height};
    EXPECT_EQ(compose(*sink, views).pixels, make_quilt(views, layout).pixels) << spec;
  }
}

/// Share of subpixels that differ by more than a rounding step.
double differing(const Image& a, const Image& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) differ += std::abs(a.pixels[i] - b.pixels[i]) > 1;
  return static_cast<double>(differ) / static_cast<double>(a.pixels.size());
}

TEST_F(SinksGl, LensWeavesEqualTheReference) {
  // Nearest views of noise: a subpixel that shows another view has another colour.
  const PanelSet& panels = built_in_panels();
  for (const char* name : {"looking-glass-portrait", "looking-glass-16-gen3-portrait", "lens-sheet-24-5-views"})
    for (const char* filter : {"nearest", "linear", "gaussian3", "gaussian10"}) {
      if (std::string_view(name).find("gen3") != std::string_view::npos && filter != std::string_view("nearest"))
        continue;
      PanelProfile profile = panels.find(name).value();
      profile.sheet->fringe = filter[0] == 'l' ? -0.25 : 0.0;
      SinkCatalog catalog;
      catalog.put(profile);
      auto sink = catalog.make(std::string("lenticular:") + name + "," + filter).value();
      // A window at the panel's far corner: the largest phases, and the panel's coordinates must count.
      const Screen screen{.width_px = profile.width_px,
                          .height_px = profile.height_px,
                          .window_x = profile.width_px - 96,
                          .window_y = 8,
                          .window_w = 96,
                          .window_h = 64};
      ASSERT_TRUE(sink->configure(screen));
      SinkTraits traits = sink->traits();
      ASSERT_EQ(traits.output, (PixelSize{96, 64}));
      std::vector<Image> views;  // one colour a view: sampling does not matter, the choice of the view does
      for (int i = 0; i < traits.views; ++i) {
        Image image(traits.view.width, traits.view.height, 4);
        for (std::size_t j = 0; j < image.pixels.size(); ++j)
          image.pixels[j] = static_cast<std::uint8_t>(j % 4 == 3 ? 255 : (std::size_t{89} * i + 31 * (j % 4)) % 256);
        views.push_back(std::move(image));
      }
      const Image out = compose(*sink, views);
      const LensSheet sheet = lens_sheet(*profile.sheet);
      Image expected(96, 64, 3);
      const ViewFilter mode = std::string_view(filter) == "nearest"     ? ViewFilter::kNearest
                              : std::string_view(filter) == "linear"    ? ViewFilter::kLinear
                              : std::string_view(filter) == "gaussian3" ? ViewFilter::kGaussian3
                                                                        : ViewFilter::kGaussian10;
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
          for (int k = 0; k < 3; ++k) {
            const double place = lens_position(sheet, profile.width_px - 96 + x, profile.height_px - 1 - (8 + y), k);
            double sum = 0;
            for (const auto& [view, weight] : view_weights(place, traits.views, mode))
              sum += weight * linear_from_srgb(views[view].at(0, 0)[k]);
            const double dimmed = row_light(sheet, profile.height_px - 1 - (8 + y));
            expected.at(x, y)[k] = static_cast<std::uint8_t>(std::lround(255 * dimmed * coded_from_linear(sum)));
          }
      EXPECT_LE(differing(out, expected), 0.0005) << name << " " << filter;
    }
}

TEST_F(SinksGl, WholePanelWeaveEqualsTheReferenceOnNoise) {
  auto sink = SinkCatalog().make("lenticular:lens-sheet-24-5-views,linear").value();
  ASSERT_TRUE(sink->configure({}));
  const auto profile = built_in_panels().find("lens-sheet-24-5-views").value();
  const auto views = noise(sink->traits());
  EXPECT_LE(differing(compose(*sink, views), weave_views(views, lens_sheet(*profile.sheet))), 0.0005);
}

TEST_F(SinksGl, TrackedWeaveEqualsTheReference) {
  const auto profile = built_in_panels().find("spatiallabs-15.6").value();
  auto sink = SinkCatalog().make("lenticular:spatiallabs-15.6").value();
  ASSERT_TRUE(sink->configure({}));
  const SinkTraits traits = sink->traits();
  Image white(traits.view.width, traits.view.height, 4), black = white;
  std::fill(white.pixels.begin(), white.pixels.end(), std::uint8_t{255});
  Observer viewer;
  viewer.left_mm = {88.5, 60, 500};
  viewer.right_mm = {151.5, 55, 510};
  sink->views(viewer);
  const Image out = compose(*sink, {white, black});
  const TrackedPanel panel = panel_optics(profile, profile.zone.design_distance_mm).value();
  const Image expected = weave_tracked(white, black, panel, {viewer.left_mm, viewer.right_mm});
  EXPECT_LE(differing(out, expected), 0.0005);
}

TEST_F(SinksGl, ImageWritesNumberedFilesAndNullDrawsNothing) {
  const auto folder =
      std::filesystem::temp_directory_path() / fmt::format("dubsar_sink_{}", static_cast<int>(::getpid()));
  std::filesystem::create_directories(folder);
  auto sink = SinkCatalog().make("image:path=" + (folder / "f-%.png").string()).value();
  ASSERT_TRUE(sink->configure({.window_w = 20, .window_h = 10}));
  const auto views = noise(sink->traits());
  compose(*sink, views);
  compose(*sink, views);
  const auto file = read_png(folder / "f-00001.png");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->pixels, views[0].pixels);
  std::filesystem::remove_all(folder);

  auto null = SinkCatalog().make("null").value();
  ASSERT_TRUE(null->configure({.window_w = 8, .window_h = 8}));
  auto array = ViewArray::create(8, 8, 1);
  auto surface = OffscreenSurface::create({8, 8});
  const float blue[] = {0, 0, 1, 1};
  glClearNamedFramebufferfv(surface->surface().framebuffer, GL_COLOR, 0, blue);
  ASSERT_TRUE(null->compose(*array, surface->surface()));
  const Image untouched = surface->read().value();
  EXPECT_EQ(untouched.at(3, 3)[2], 255);
}

TEST_F(SinksGl, AMeshThroughARowInterlacedPanelShowsEachEyeItsView) {
  // The whole chain: viewer -> views -> renderer -> compose; every row equals that eye's own picture.
  const LodMesh mesh = LodMesh::exact(pack_mesh(testing::lettered_box()).value()).value();
  auto renderer = Renderer::create().value();
  auto sink = SinkCatalog().make("interlaced:rows").value();
  const Screen screen{
      .width_mm = 60, .height_mm = 40, .width_px = 120, .height_px = 80, .window_w = 120, .window_h = 80};
  ASSERT_TRUE(sink->configure(screen));
  Observer viewer;
  viewer.front_mm = 10;
  viewer.back_mm = -10;
  auto array = ViewArray::create(120, 80, 2).value();
  Shading shading = shading_preset("phong").value();
  color_partitions(shading.parts, distinct_partition_colors());
  ASSERT_TRUE(renderer.render(MeshScene(mesh, shading), sink->views(viewer), 1, array));
  auto surface = OffscreenSurface::create({120, 80}).value();
  ASSERT_TRUE(sink->compose(array, surface.surface()));
  const Image out = surface.read().value(), left = array.read_layer(0).value(), right = array.read_layer(1).value();
  EXPECT_NE(left.pixels, right.pixels);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 120; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(out.at(x, y)[c], (y % 2 == 0 ? left : right).at(x, y)[c]);
}

TEST_F(SinksGl, ShutterShowsOneWholeViewAtEachTurn) {
  for (const bool right_first : {false, true}) {
    auto sink = SinkCatalog().make(right_first ? "shutter:right_first" : "shutter:left_first").value();
    ASSERT_TRUE(sink->configure({.window_w = 33, .window_h = 21}));
    ASSERT_EQ(sink->traits().fields, 2);
    const auto views = noise(sink->traits());
    auto array = ViewArray::create(33, 21, 2);
    for (int eye = 0; eye < 2; ++eye) ASSERT_TRUE(array->write_layer(eye, views[eye]));
    auto surface = OffscreenSurface::create({33, 21});
    for (const Field field : {Field::kFirst, Field::kSecond, Field::kFirst, Field::kFirst, Field::kSecond}) {
      ASSERT_TRUE(sink->compose(*array, surface->surface(), field));
      const Image& eye = views[(field == Field::kSecond) != right_first ? 1 : 0];
      const Image out = surface->read().value();
      for (int y = 0; y < 21; ++y)
        for (int x = 0; x < 33; ++x)
          for (int c = 0; c < 3; ++c) ASSERT_EQ(out.at(x, y)[c], eye.at(x, y)[c]);
    }
  }
}

TEST_F(SinksGl, QuadBufferPutsEachViewIntoItsOwnBufferOfAStandIn) {
  // A frame buffer with two colour attachments stands in for the left and the right back buffer.
  auto sink = SinkCatalog().make("quad_buffer").value();
  ASSERT_TRUE(sink->configure({.width_px = 31, .height_px = 17, .window_w = 31, .window_h = 17}));
  ASSERT_TRUE(sink->traits().stereo_visual);
  const auto views = noise(sink->traits());
  auto array = ViewArray::create(31, 17, 2);
  for (int eye = 0; eye < 2; ++eye) ASSERT_TRUE(array->write_layer(eye, views[eye]));
  std::array<GlTexture, 2> pictures;
  const GlFramebuffer buffers = make_framebuffer();
  for (int eye = 0; eye < 2; ++eye) {
    pictures[eye] = make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(pictures[eye], 1, GL_RGBA8, 31, 17);
    glNamedFramebufferTexture(buffers, GL_COLOR_ATTACHMENT0 + eye, pictures[eye], 0);
  }
  const auto done = sink->compose(*array, {buffers, 31, 17, {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1}});
  ASSERT_TRUE(done) << done.error().message;
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  for (int eye = 0; eye < 2; ++eye) {
    Image read(31, 17, 4);
    glGetTextureImage(pictures[eye], 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(read.pixels.size()),
                      read.pixels.data());
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 31; ++x)
        for (int c = 0; c < 3; ++c) ASSERT_EQ(read.at(x, 16 - y)[c], views[eye].at(x, y)[c]) << "eye " << eye;
  }
}

}  // namespace
}  // namespace dubsar
