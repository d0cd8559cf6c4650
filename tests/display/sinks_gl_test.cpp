// Every sink's GL half against its CPU reference, on noise: any mistake in parity, order or place shows.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "core/image_io/png_file.h"
#include "display/compose_pass.h"
#include "display/context_egl.h"
#include "display/gpu_mesh.h"
#include "display/output_sink.h"
#include "display/renderer.h"
#include "display/sinks/anaglyph.h"
#include "display/sinks/interlaced.h"
#include "display/sinks/packed.h"
#include "display/sinks/quilt.h"
#include "tests/display/test_meshes.h"

namespace dubsar {
namespace {

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
      for (auto& value : image.pixels) value = static_cast<std::uint8_t>((state_ = state_ * 1664525u + 1013904223u) >> 24);
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
  auto sink = make_sink("mono").value();
  ASSERT_TRUE(sink->configure({.window_w = 37, .window_h = 23}));
  const auto views = noise(sink->traits());
  const Image out = compose(*sink, views);
  for (int y = 0; y < 23; ++y)
    for (int x = 0; x < 37; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(out.at(x, y)[c], views[0].at(x, y)[c]);
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
      auto sink = make_sink(c.spec).value();
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
        auto sink = make_sink(std::string("interlaced:") + names[pattern] + (right_first ? ",right_first" : "")).value();
        const Screen screen{.window_x = x, .window_y = y, .window_w = 31, .window_h = 22};
        ASSERT_TRUE(sink->configure(screen));
        const auto views = noise(sink->traits());
        EXPECT_EQ(compose(*sink, views).pixels,
                  interlace_views(views[0], views[1], screen, static_cast<InterlacePattern>(pattern), right_first).pixels)
            << names[pattern] << " at " << x << ", " << y;
      }
}

TEST_F(SinksGl, AnaglyphsEqualTheReferenceToOneStep) {
  for (const AnaglyphVariant& variant : anaglyph_variants()) {
    auto sink = make_sink("anaglyph:" + std::string(variant.name)).value();
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
  for (const char* spec : {"quilt:columns=3,rows=2,width=61,height=43,aspect=1", "quilt:columns=5,rows=9,width=100,height=99"}) {
    auto sink = make_sink(spec).value();
    ASSERT_TRUE(sink->configure({}));
    const SinkTraits traits = sink->traits();
    const auto views = noise(traits);
    const QuiltLayout layout{traits.views == 6 ? 3 : 5, traits.views == 6 ? 2 : 9, traits.output.width, traits.output.height};
    EXPECT_EQ(compose(*sink, views).pixels, make_quilt(views, layout).pixels) << spec;
  }
}

TEST_F(SinksGl, ImageWritesNumberedFilesAndNullDrawsNothing) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("dubsar_sink_{}", static_cast<int>(::getpid()));
  std::filesystem::create_directories(folder);
  auto sink = make_sink("image:path=" + (folder / "f-%.png").string()).value();
  ASSERT_TRUE(sink->configure({.window_w = 20, .window_h = 10}));
  const auto views = noise(sink->traits());
  compose(*sink, views);
  compose(*sink, views);
  const auto file = read_png(folder / "f-00001.png");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->pixels, views[0].pixels);
  std::filesystem::remove_all(folder);

  auto null = make_sink("null").value();
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
  auto gpu = GpuMesh::upload(pack_mesh(testing::lettered_box()).value()).value();
  auto renderer = Renderer::create().value();
  auto sink = make_sink("interlaced:rows").value();
  const Screen screen{.width_mm = 60, .height_mm = 40, .width_px = 120, .height_px = 80, .window_w = 120, .window_h = 80};
  ASSERT_TRUE(sink->configure(screen));
  Viewer viewer;
  viewer.front_mm = 10;
  viewer.back_mm = -10;
  auto array = ViewArray::create(120, 80, 2).value();
  Shading shading = shading_preset("phong").value();
  shading.partition_colors = distinct_partition_colors();
  ASSERT_TRUE(renderer.render(gpu, shading, sink->views(viewer), 1, array));
  auto surface = OffscreenSurface::create({120, 80}).value();
  ASSERT_TRUE(sink->compose(array, surface.surface()));
  const Image out = surface.read().value(), left = array.read_layer(0).value(), right = array.read_layer(1).value();
  EXPECT_NE(left.pixels, right.pixels);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 120; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(out.at(x, y)[c], (y % 2 == 0 ? left : right).at(x, y)[c]);
}

}  // namespace
}  // namespace dubsar
