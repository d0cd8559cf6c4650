// Windows on an X server without a screen: what is in the window is what the sink draws offscreen.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "display/render/context/context_egl.h"
#include "display/render/context/context_glfw.h"
#include "display/render/images/test_pattern.h"
#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/sink_window.h"
#include "tests/display/xvfb_server.h"

namespace dubsar {
namespace {

class Window : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { server_ = std::make_unique<testing::XvfbServer>(); }
  static void TearDownTestSuite() { server_.reset(); }
  void SetUp() override {
    if (!server_->problem().empty()) GTEST_SKIP() << server_->problem();
  }
  inline static std::unique_ptr<testing::XvfbServer> server_;
};

/// Composes numbered views for the sink into `target`.
void compose(OutputSink& sink, const Surface& target) {
  const SinkTraits traits = sink.traits();
  auto array = ViewArray::create(traits.view.width, traits.view.height, traits.views);
  ASSERT_TRUE(array) << array.error().message;
  static_cast<void>(sink.views(Observer()));
  for (int i = 0; i < traits.views; ++i)
    ASSERT_TRUE(array->write_layer(i, numbered_view(traits.view.width, traits.view.height, i, traits.views)));
  const auto done = sink.compose(*array, target);
  ASSERT_TRUE(done) << done.error().message;
}

Image offscreen(std::string_view display, const Screen& screen) {
  auto context = EglContext::create();
  EXPECT_TRUE(context);
  auto sink = SinkCatalog().make(display).value();
  EXPECT_TRUE(sink->configure(screen));
  auto surface = OffscreenSurface::create(sink->traits().output);
  compose(*sink, surface->surface());
  return surface->read().value();
}

/// What GL says was drawn, and what is on the X server's screen after presenting it.
void screenshot(std::string_view display, const WindowOptions& options, const testing::XvfbServer& server,
                Screen& screen, Image& back, Image& front) {
  auto shown = open_sink_window({}, parse_sink_spec(display).value(), options);
  ASSERT_TRUE(shown) << shown.error().message;
  EXPECT_EQ(shown->note, "") << display;
  EXPECT_EQ(shown->window->size(), (PixelSize{options.width, options.height}));
  screen = shown->window->screen();
  compose(*shown->sink, shown->window->surface());
  back = shown->window->read().value();
  shown->window->present();
  shown->window->poll_events();
  screen = shown->window->screen();  // asks the server, so that it has done all before
  front = server.screen(screen.window_x, screen.window_y, screen.window_w, screen.window_h);
}

TEST_F(Window, ShowsWhatTheSinkDrawsOffscreen) {
  for (const char* display : {"mono", "interlaced", "interlaced:checkerboard", "interlaced:columns,right_first",
                              "anaglyph", "lenticular:lens-sheet-24-5-views"}) {
    const bool whole_panel = std::string_view(display).starts_with("lenticular");
    WindowOptions options;
    options.width = whole_panel ? 1920 : 301;  // odd sizes and places: parity and padding mistakes show
    options.height = whole_panel ? 1080 : 203;
    options.decorated = false;
    options.x = whole_panel ? 0 : 37;
    options.y = whole_panel ? 0 : 61;
    Screen screen;
    Image back, front;
    ASSERT_NO_FATAL_FAILURE(screenshot(display, options, *server_, screen, back, front));
    EXPECT_EQ(screen.width_px, 1920);
    EXPECT_EQ(screen.height_px, 1200);
    EXPECT_EQ(screen.window_x, *options.x) << "the place on the panel is exact";
    EXPECT_EQ(screen.window_y, *options.y);
    const Image expected = offscreen(display, screen);
    EXPECT_EQ(back.pixels, expected.pixels) << display;
    EXPECT_EQ(front.pixels, expected.pixels) << display;
    EXPECT_NE(*std::max_element(expected.pixels.begin(), expected.pixels.end()), 0) << display;
  }
}

TEST_F(Window, InterlacedParityFollowsThePanelNotTheWindow) {
  std::array<Image, 2> pictures;
  for (int i = 0; i < 2; ++i) {
    WindowOptions options;
    options.width = 64;
    options.height = 48;
    options.x = 10;
    options.y = 20 + i;
    auto shown = open_sink_window({}, {"interlaced"}, options);
    ASSERT_TRUE(shown) << shown.error().message;
    compose(*shown->sink, shown->window->surface());
    pictures[i] = shown->window->read().value();
  }
  EXPECT_NE(pictures[0].pixels, pictures[1].pixels) << "one row lower, the eyes change places";
}

TEST_F(Window, FullScreenIsTheMonitorsSize) {
  const auto monitors = list_monitors();
  ASSERT_TRUE(monitors) << monitors.error().message;
  ASSERT_EQ(monitors->size(), 1u);
  EXPECT_EQ(monitors->front().width_px, 1920);
  EXPECT_TRUE(monitors->front().primary);
  WindowOptions options;
  options.monitor = monitors->front().name;
  options.fullscreen = true;
  const auto window = GlfwWindow::create(options);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ((*window)->size(), (PixelSize{1920, 1200}));
  EXPECT_EQ((*window)->screen().window_x, 0);
}

TEST_F(Window, UnknownMonitorsAreNamedWithThoseThereAre) {
  WindowOptions options;
  options.monitor = "LKG-nowhere";
  const auto window = GlfwWindow::create(options);
  ASSERT_FALSE(window);
  EXPECT_EQ(window.error().kind, ErrorKind::kUsage);
  EXPECT_NE(window.error().message.find(list_monitors()->front().name), std::string::npos) << window.error().message;
}

TEST_F(Window, QuadBuffersAreUsedWhereTheyExistAndElseTheNoteSaysWhatIsShown) {
  WindowOptions options;
  options.width = 200;
  options.height = 100;
  options.decorated = false;
  auto shown = open_sink_window({}, {"quad_buffer"}, options);
  ASSERT_TRUE(shown) << shown.error().message;
  compose(*shown->sink, shown->window->surface());
  EXPECT_TRUE(shown->window->stereo() || std::getenv("DUBSAR_EXPECT_STEREO") == nullptr)
      << "a stereo visual was promised";
  if (shown->window->stereo()) {  // VirtualGL, or a professional card behind the test's server
    EXPECT_EQ(shown->note, "");
    for (int eye = 0; eye < 2; ++eye) {
      const Image picture = shown->window->read(eye).value(), expected = numbered_view(200, 100, eye, 2);
      for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 200; ++x)
          for (int c = 0; c < 3; ++c) ASSERT_EQ(picture.at(x, y)[c], expected.at(x, y)[c]) << "eye " << eye;
    }
    return;
  }
  EXPECT_EQ(shown->sink->traits().name, "side_by_side");
  EXPECT_NE(shown->note.find("quad_buffer"), std::string::npos);
  EXPECT_NE(shown->note.find("side_by_side is shown instead"), std::string::npos) << shown->note;
  const Surface mono = shown->window->surface();
  auto sink = SinkCatalog().make("quad_buffer").value();
  ASSERT_TRUE(sink->configure(shown->window->screen()));
  auto array = ViewArray::create(200, 100, 2);
  const auto refused = sink->compose(*array, mono);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUnavailable);
}

TEST_F(Window, NoDisplayServerIsASentence) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a new process: GLFW starts once in each
  EXPECT_EXIT(
      {
        ::setenv("DISPLAY", ":nowhere", 1);
        ::unsetenv("WAYLAND_DISPLAY");
        const auto monitors = list_monitors();
        std::exit(!monitors && monitors.error().kind == ErrorKind::kUnavailable ? 3 : 4);
      },
      ::testing::ExitedWithCode(3), "");
}

}  // namespace
}  // namespace dubsar
