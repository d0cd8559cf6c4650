// View k painted with colour k arrives where view k belongs, through every sink and a model of its display:
// lenses by the optical simulator, glasses by their filters, packed and interlaced pictures by which pixels a
// display sends to an eye.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <numbers>

#include "core/base/files/atomic_file.h"
#include "display/optics/optics.h"
#include "display/optics/srgb.h"
#include "display/panels/panel_set.h"
#include "display/render/context/context_egl.h"
#include "display/render/images/test_pattern.h"
#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/catalog/plugin_sink.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "display/sinks/field_cadence.h"
#include "display/sinks/interlaced.h"
#include "display/sinks/openxr.h"
#include "display/sinks/quilt.h"
#include "tests/display/reference_pictures.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

constexpr int kPanelWidth = 96, kPanelHeight = 54;
constexpr Screen kPanelScreen{
    .width_px = kPanelWidth, .height_px = kPanelHeight, .window_w = kPanelWidth, .window_h = kPanelHeight};

/// Two small panels with the lenses of real ones, so that whole pictures can be looked at.
constexpr const char* kSmallPanels = R"([
  {"name": "small-tracked", "kind": "tracked", "width_px": 360, "height_px": 60, "width_mm": 32.38, "design_distance_mm": 600, "ipd_mm": 63,
   "optics": {"pitch_mm": 0.200884, "tan_slant": 0.333333, "reduced_gap_mm": 0.956589, "refractive_index": 1.5, "phase0": 0.3, "spot_sigma_periods": 0.1}},
  {"name": "small-sheet", "kind": "lens_sheet", "width_px": 400, "height_px": 60, "dpi": 91.8, "view_cone_deg": 20, "views": 5,
   "lens": {"pitch": 55.1, "slope": -6.0, "center": 0.2}},
  {"name": "small-glass", "kind": "looking_glass", "width_px": 400, "height_px": 60, "dpi": 324, "view_cone_deg": 40, "aspect": 1,
   "quilt": {"columns": 4, "rows": 3, "width_px": 160, "height_px": 120}, "lens": {"pitch": 52.6, "slope": -7.2, "center": 0.4}},
  {"name": "small-gen3", "kind": "looking_glass", "width_px": 400, "height_px": 60, "dpi": 283, "view_cone_deg": 50, "aspect": 1,
   "quilt": {"columns": 4, "rows": 3, "width_px": 160, "height_px": 120},
   "lens": {"pitch": 44.72, "slope": -7.45, "center": 0.1, "cell_pattern": 4,
            "cells": [{"R": [-0.25, -0.31], "G": [-0.25, 0.28], "B": [0.25, 0]}, {"R": [0.25, -0.31], "G": [0.25, 0.28], "B": [-0.25, 0]}]}}])";

using LinearLight = glm::dvec3;  ///< linear

LinearLight light_of(const Rgb8& c) { return {linear_from_srgb(c[0]), linear_from_srgb(c[1]), linear_from_srgb(c[2])}; }

/// Mean light of the pixels that `chosen` names, top row first, without a border.
LinearLight mean_light(
    const Image& image, int border, const std::function<bool(int, int)>& chosen = [](int, int) { return true; }) {
  LinearLight sum(0.0);
  int count = 0;
  for (int y = border; y < image.height - border; ++y)
    for (int x = border; x < image.width - border; ++x)
      if (chosen(x, y)) {
        const std::uint8_t* p = image.at(x, y);
        sum += light_of({p[0], p[1], p[2]});
        ++count;
      }
  return sum / std::max(1.0, static_cast<double>(count));
}

/// A headset that keeps what it is handed for each eye.
class KeepingHeadset final : public Headset {
 public:
  explicit KeepingHeadset(std::array<Image, 2>& worn) : worn_(&worn) {}
  PixelSize eye_size() const override { return {40, 30}; }
  std::optional<WearerFrame> begin() override { return WearerFrame(); }
  Result<void> end(const ViewArray& views) override {
    for (int eye = 0; eye < 2; ++eye) (*worn_)[static_cast<std::size_t>(eye)] = views.read_layer(eye).value();
    return {};
  }
  std::string reason() const override { return {}; }

 private:
  std::array<Image, 2>* worn_;
};

class Directions : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = EglContext::create();
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
    fs::create_directories(folder_);
    ASSERT_TRUE(write_file_atomically(folder_ / "small.json", kSmallPanels));
  }
  void TearDown() override { fs::remove_all(folder_); }

  void open(const std::string& spec, const Observer& viewer = {}) {
    auto made = SinkCatalog(load_panels(folder_), plugins_).make(spec);
    ASSERT_TRUE(made) << made.error().message;
    sink_ = std::move(*made);
    ASSERT_TRUE(sink_->configure(kPanelScreen));
    sink_->views(viewer);
  }
  /// A display of a shared library, or one of ours.
  void open_of(const std::string& plugin, const std::string& spec) {
    std::vector<std::shared_ptr<SinkPlugin>> plugins;
    if (!plugin.empty()) {
      auto loaded = load_plugins({plugin});
      ASSERT_TRUE(loaded) << loaded.error().message;
      plugins = std::move(*loaded);
    }
    plugins_ = std::move(plugins);
    open(spec);
  }
  /// Distinct hues; for views that mix with their neighbours a ramp of light, whose mean stays where it is.
  Rgb8 color(int view) const {
    const int views = sink_->traits().views;
    if (!ramp_) return pattern_color(view, views);
    const std::uint8_t grey = srgb_from_linear((view + 1.0) / (views + 1.0));
    return {grey, grey, grey};
  }
  ViewArray painted() const {
    const SinkTraits traits = sink_->traits();
    auto array = ViewArray::create(traits.view.width, traits.view.height, traits.views).value();
    for (int k = 0; k < traits.views; ++k) {
      Image image(traits.view.width, traits.view.height, 4);
      const Rgb8 c = color(k);
      for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i % 4 == 3 ? std::uint8_t{255} : c[i % 4];
      EXPECT_TRUE(array.write_layer(k, image));
    }
    return array;
  }
  Image composed() const {
    auto surface = OffscreenSurface::create(sink_->traits().output).value();
    const auto done = sink_->compose(painted(), surface.surface());
    EXPECT_TRUE(done) << done.error().message;
    return surface.read().value();
  }
  /// The view whose colour comes nearest to what was seen.
  int nearest_view_to(const LinearLight& seen) const {
    int best = 0;
    for (int k = 1; k < sink_->traits().views; ++k)
      if (glm::length(light_of(color(k)) - seen) < glm::length(light_of(color(best)) - seen)) best = k;
    return best;
  }
  void expect_view(int view, const LinearLight& seen, double most_off, const std::string& what) const {
    EXPECT_EQ(nearest_view_to(seen), view) << what;
    EXPECT_LT(glm::length(light_of(color(view)) - seen), most_off) << what;
  }

  void one_view(const std::string& spec) {
    open(spec);
    expect_view(0, mean_light(composed(), 0), 1e-9, spec);
  }
  void packed(const std::string& spec, bool vertical, bool right_first, int gap = 0) {
    open(spec);
    const Image picture = composed();
    const int half = ((vertical ? picture.height : picture.width) - gap) / 2;
    for (int eye = 0; eye < 2; ++eye) {
      const bool second = (eye == 1) != right_first;
      const auto at_eye = [&](int x, int y) {
        const int along = vertical ? y : x;
        return second ? along >= half + gap : along < half;
      };
      expect_view(eye, mean_light(picture, 0, at_eye), 1e-9, spec);
    }
  }
  void interlaced(const std::string& spec, InterlacePattern pattern) {
    open(spec);
    const Image picture = composed();
    for (int eye = 0; eye < 2; ++eye) {
      LinearLight sum(0.0);
      for (int c = 0; c < 3; ++c)  // a polariser passes subpixel by subpixel
        sum[c] =
            mean_light(picture, 0, [&](int x, int y) { return testing::interlace_parity(pattern, x, y, c) == eye; })[c];
      expect_view(eye, sum, 1e-9, spec);
    }
  }
  /// Glasses pass whole channels; of white against black each eye gets its own light and little of the
  /// other's.
  void glasses(const std::string& spec, const glm::dvec3& left_filter) {
    open(spec);
    for (int lit = 0; lit < 2; ++lit) {
      auto array = ViewArray::create(kPanelWidth, kPanelHeight, 2).value();
      for (int k = 0; k < 2; ++k) {
        Image image(kPanelWidth, kPanelHeight, 4);
        std::fill(image.pixels.begin(), image.pixels.end(), static_cast<std::uint8_t>(k == lit ? 255 : 0));
        ASSERT_TRUE(array.write_layer(k, image));
      }
      auto surface = OffscreenSurface::create(sink_->traits().output).value();
      ASSERT_TRUE(sink_->compose(array, surface.surface()));
      const LinearLight light = mean_light(surface.read().value(), 0);
      const glm::dvec3 right_filter = glm::dvec3(1.0) - left_filter;
      const double by_left = glm::dot(light, left_filter) / glm::dot(left_filter, left_filter);
      const double by_right = glm::dot(light, right_filter) / glm::dot(right_filter, right_filter);
      EXPECT_GT(lit == 0 ? by_left : by_right, 0.5) << spec;
      EXPECT_LT(lit == 0 ? by_right : by_left, 0.02) << spec;
    }
  }
  /// An eye in the middle of each view's zone; where neighbours are mixed (linear), view k is alone where its
  /// zone begins.
  void lenses(const std::string& panel, const std::string& filter) {
    ramp_ = true;
    open("lenticular:" + panel + "," + filter);
    const Image picture = composed();
    const auto light = sink_->light();
    ASSERT_TRUE(light);
    const PanelProfile profile = load_panels(folder_).find(panel).value();
    const int views = sink_->traits().views;
    const double half_cone = 0.5 * profile.zone.cone_deg * std::numbers::pi / 180, z = viewing_distance_mm(profile);
    for (int k = filter == "linear" ? 2 : 1;
         k<views - 1; k += views> 6 ? 3 : 1) {                              // the outer ones mix with each other
      const double place = (k + (filter == "linear" ? 0.0 : 0.5)) / views;  // 0..1 across the cone
      const glm::dvec3 eye(z * std::tan(half_cone) * (2 * place - 1), 0.0, z);
      expect_view(k, mean_light(see(picture, light->panel, eye), 20), std::sqrt(3.0) * 0.5 / (views + 1.0),
                  panel + " " + filter + ", view " + std::to_string(k));
    }
  }

  fs::path folder_ = fs::temp_directory_path() / ("dubsar_directions_" + std::to_string(::getpid()));
  std::unique_ptr<EglContext> context_;
  std::unique_ptr<OutputSink> sink_;
  std::vector<std::shared_ptr<SinkPlugin>> plugins_;  // outlive what they made
  bool ramp_ = false;
};

TEST_F(Directions, EveryViewArrivesAtTheEyeItIsFor) {
  const std::map<std::string_view, std::function<void()>> cases{
      {"mono", [&] { one_view("mono"); }},
      {"image", [&] { one_view("image:path=" + (folder_ / "f-%.png").string()); }},
      {"null", [] {}},  // shows nothing to anybody
      {"side_by_side",
       [&] {
         packed("side_by_side", false, false);
         packed("side_by_side:full,right_first", false, true);
       }},
      {"top_bottom",
       [&] {
         packed("top_bottom", true, false);
         packed("top_bottom:full,right_first", true, true);
         packed("top_bottom:frame_packing", true, false, kPanelHeight / 24);
       }},
      {"interlaced",
       [&] {
         interlaced("interlaced:rows", InterlacePattern::kRows);
         interlaced("interlaced:columns", InterlacePattern::kColumns);
         interlaced("interlaced:checkerboard", InterlacePattern::kCheckerboard);
         interlaced("interlaced:subpixels", InterlacePattern::kSubpixels);
       }},
      {"anaglyph",
       [&] {
         glasses("anaglyph:red_cyan_full", {1, 0, 0});
         glasses("anaglyph:red_cyan_dubois", {1, 0, 0});
         glasses("anaglyph:green_magenta_dubois", {0, 1, 0});
         glasses("anaglyph:amber_blue_full", {1, 1, 0});
       }},
      {"lenticular",
       [&] {
         for (const char* panel : {"small-sheet", "small-glass", "small-gen3"}) lenses(panel, "nearest");
         lenses("small-glass", "linear");
         ramp_ = false;
         Observer viewer;
         viewer.left_mm = {-11.5, 20, 590};
         viewer.right_mm = {51.5, 20, 590};
         open("lenticular:small-tracked", viewer);
         const Image picture = composed();
         for (int eye = 0; eye < 2; ++eye)
           expect_view(eye,
                       mean_light(see(picture, sink_->light()->panel, eye == 0 ? viewer.left_mm : viewer.right_mm), 20),
                       0.1, "tracked");
       }},
      {"quad_buffer",
       [&] {
         open("quad_buffer");
         std::array<GlTexture, 2> pictures;
         const GlFramebuffer buffers = make_framebuffer();
         for (int eye = 0; eye < 2; ++eye) {
           pictures[eye] = make_texture(GL_TEXTURE_2D);
           glTextureStorage2D(pictures[eye], 1, GL_RGBA8, kPanelWidth, kPanelHeight);
           glNamedFramebufferTexture(buffers, GL_COLOR_ATTACHMENT0 + eye, pictures[eye], 0);
         }
         ASSERT_TRUE(sink_->compose(
             painted(), {buffers, kPanelWidth, kPanelHeight, {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1}}));
         for (int eye = 0; eye < 2; ++eye) {
           Image read(kPanelWidth, kPanelHeight, 4);
           glGetTextureImage(pictures[eye], 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(read.pixels.size()),
                             read.pixels.data());
           expect_view(eye, mean_light(read, 0), 1e-9, "quad_buffer");
         }
       }},
      {"shutter",
       [&] {
         // Glasses open the left eye at even beats; the present loop is late now and then, and holds a picture.
         open("shutter");
         const ViewArray views = painted();
         FieldCadence cadence;
         cadence.set_refresh(120.0);
         const double beat_ns = 1e9 / 119.88;
         std::array<LinearLight, 2> light{LinearLight(0.0), LinearLight(0.0)};
         std::array<int, 2> open_beats{0, 0};
         auto surface = OffscreenSurface::create(sink_->traits().output).value();
         std::int64_t beat = 0;
         for (int picture = 0; picture < 400; ++picture) {
           const std::int64_t next = beat + (picture % 7 == 3 ? 2 : 1);  // ready after the beat that it was begun for
           const auto time = [&](std::int64_t b, double late_ms) {
             return static_cast<TimestampNs>(static_cast<double>(b) * beat_ns + 1e6 * late_ms);
           };
           const Field field = cadence.next(cadence.turn(time(next, -4.0)));
           ASSERT_TRUE(sink_->compose(views, surface.surface(), field));
           const LinearLight shown = mean_light(surface.read().value(), 0);
           beat = next;  // in between, the picture before was held
           cadence.presented(time(beat, 0.5 * (picture % 3)));
           const auto eye = static_cast<std::size_t>(beat % 2);
           light[eye] += shown;
           ++open_beats[eye];
         }
         // Which of the two orders the glasses have, a switch on them says.
         const int first = nearest_view_to(light[0] / static_cast<double>(open_beats[0]));
         for (std::size_t eye = 0; eye < 2; ++eye) {
           EXPECT_GT(open_beats[eye], 150);
           expect_view(eye == 0 ? first : 1 - first, light[eye] / static_cast<double>(open_beats[eye]), 1e-9,
                       "shutter");
         }
       }},
      {"openxr",
       [&] {
         std::array<Image, 2> worn;
         sink_ = openxr_sink(std::make_unique<KeepingHeadset>(worn));
         ASSERT_TRUE(sink_->configure(kPanelScreen));
         sink_->views({});  // nominal cameras, then the wearer's
         sink_->views({});
         composed();
         for (int eye = 0; eye < 2; ++eye)
           expect_view(eye, mean_light(worn[static_cast<std::size_t>(eye)], 0), 1e-9, "openxr");
       }},
      {"quilt", [&] {
         open("quilt:small-glass");
         const auto tiles = split_quilt(composed(), {4, 3, 160, 120});
         for (int k = 0; k < 12; ++k) expect_view(k, mean_light(tiles[static_cast<std::size_t>(k)], 0), 1e-9, "quilt");
       }}};
  for (const SinkBackend& backend : output_sinks()) {
    const auto found = cases.find(backend.name);
    ASSERT_NE(found, cases.end()) << "no model of what eyes see of display " << backend.name;
    found->second();
    sink_.reset();
  }
}

/// For whoever makes a display: DUBSAR_SINK=NAME[:options], DUBSAR_SINK_PLUGIN=FILE.so where it is of a shared library,
/// and DUBSAR_SINK_LIKE, one of the names below: what its viewer's eyes pick out of a picture.
TEST_F(Directions, OfTheDisplayThatIsNamedAreThoseOfTheOneThatItIsLike) {
  const auto said = [](const char* name) {
    const char* const value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  const std::string spec = said("DUBSAR_SINK"), like = said("DUBSAR_SINK_LIKE");
  if (spec.empty()) GTEST_SKIP() << "no display is named by DUBSAR_SINK (docs/displays.md)";
  const std::map<std::string, std::function<void()>> models{
      {"mono", [&] { one_view(spec); }},
      {"left_right", [&] { packed(spec, false, false); }},
      {"right_left", [&] { packed(spec, false, true); }},
      {"left_above", [&] { packed(spec, true, false); }},
      {"left_below", [&] { packed(spec, true, true); }},
      {"rows", [&] { interlaced(spec, InterlacePattern::kRows); }},
      {"columns", [&] { interlaced(spec, InterlacePattern::kColumns); }},
      {"checkerboard", [&] { interlaced(spec, InterlacePattern::kCheckerboard); }},
      {"subpixels", [&] { interlaced(spec, InterlacePattern::kSubpixels); }},
      {"red_cyan",
       [&] {
         glasses(spec, {1, 0, 0});
       }},
      {"green_magenta", [&] {
         glasses(spec, {0, 1, 0});
       }}};
  std::string known;
  for (const auto& [name, model] : models) known += (known.empty() ? "" : ", ") + name;
  const auto model = models.find(like);
  ASSERT_NE(model, models.end()) << "DUBSAR_SINK_LIKE=" << like << " found, expected one of " << known;
  open_of(said("DUBSAR_SINK_PLUGIN"), spec);
  if (HasFatalFailure()) return;
  model->second();
  sink_.reset();
}

}  // namespace
}  // namespace dubsar
