#include "display/sinks/lenticular.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <vector>

#include "display/panels/panel_profile.h"
#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/stereo_views.h"

namespace dubsar {
namespace {

// shaders/lens_views.frag and shaders/lens_tracked.frag
constexpr GLint kWindow = 0;
constexpr GLint kSteps = 1, kStart = 2, kMode = 3, kSigma = 4, kCells = 5, kOffsets = 6, kFringe = 36;
constexpr GLint kPanelPx = 1, kPixelMm = 2, kLens = 3, kPhase0 = 4, kEyes = 5, kTrackedOffsets = 7;
constexpr std::size_t kMaxCells = 10;
constexpr int kCoarseBits = 11;  // times a pixel number below 8192: 24 bits, exact in a float

/// The panel's own screen: the given window when it is on such a panel, else all of it.
Screen panel_screen(const PanelProfile& profile, const Screen& given) {
  const bool same = given.width_px == profile.width_px && given.height_px == profile.height_px;
  Screen screen = given;
  screen.width_mm = profile.width_mm;
  screen.height_mm = profile.height_mm();
  screen.width_px = profile.width_px;
  screen.height_px = profile.height_px;
  if (!same) {
    screen.window_x = screen.window_y = 0;
    screen.window_w = profile.width_px;
    screen.window_h = profile.height_px;
  }
  return screen;
}

void set_window(const Screen& s) {
  glUniform4i(kWindow, s.window_x, s.height_px - s.window_y - s.window_h, s.window_w, s.window_h);
}

std::vector<glm::vec2> flat_offsets(const SubpixelLayout& layout) {
  std::vector<glm::vec2> offsets;
  for (const SubpixelCell& cell : layout.cells)
    for (const glm::dvec2& offset : cell.offset_px) offsets.emplace_back(offset);
  return offsets;
}

class ViewsSink : public OutputSink {
 public:
  ViewsSink(PanelProfile profile, ViewFilter filter, const ViewFocus& focus)
      : profile_(std::move(profile)),
        sheet_(lens_sheet(*profile_.sheet)),
        filter_(filter),
        focus_(focus),
        screen_(panel_screen(profile_, {})) {}

  SinkTraits traits() const noexcept override {
    const PixelSize window{screen_.window_w, screen_.window_h};
    const PixelSize tile{profile_.quilt.views() > 0 ? profile_.quilt.tile_width() : window.width,
                         profile_.quilt.views() > 0 ? profile_.quilt.tile_height() : window.height};
    return {.name = "lenticular",
            .views = profile_.views,
            .view = tile,
            .output = window,
            .own_pixels = true,
            .own_size = true,
            .focus = focus_,
            .exact_pixels = true};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    screen_ = panel_screen(profile_, screen);
    return {};
  }
  std::span<const View> views(const Observer& viewer) override {
    const double distance = viewing_distance_mm(profile_);
    views_.clear();
    for (const glm::dvec3& eye : cone_eyes(profile_.views, profile_.zone.cone_deg * std::numbers::pi / 180, distance))
      views_.push_back(focused_view(viewer_view(screen_.window_rect(), viewer, eye), focus_,
                                    static_cast<int>(views_.size()), profile_.views));
    return views_;
  }
  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    const double right = sheet_.periods / sheet_.width_px, up = sheet_.periods * sheet_.tilt / sheet_.height_px;
    const double start = 0.5 * right + 0.5 * up - sheet_.centre;
    DUBSAR_TRY(pass_.begin(target, views.linear()));
    set_window(screen_);
    glUniform4f(kSteps, coarse(right), static_cast<float>(right - coarse(right)), coarse(up),
                static_cast<float>(up - coarse(up)));
    glUniform1f(kStart, static_cast<float>(start - std::floor(start)));
    glUniform4i(kMode, profile_.views, static_cast<int>(filter_), sheet_.invert_views ? 1 : 0,
                static_cast<int>(sheet_.subpixels.pattern));
    glUniform1f(kSigma, static_cast<float>(kViewSigma * profile_.views));
    const auto offsets = flat_offsets(sheet_.subpixels);
    glUniform1f(kFringe, static_cast<float>(sheet_.fringe));
    glUniform1i(kCells, static_cast<int>(sheet_.subpixels.cells.size()));
    glUniform2fv(kOffsets, static_cast<GLsizei>(offsets.size()), glm::value_ptr(offsets[0]));
    return pass_.draw();
  }

  std::optional<PanelLight> light() const override {
    const auto optics = panel_optics(profile_, viewing_distance_mm(profile_));
    if (!optics) return std::nullopt;
    // Half the way to the other eye, in views.
    const double eyes_deg = profile_.zone.ipd_mm / viewing_distance_mm(profile_) * 180 / std::numbers::pi;
    const int own = static_cast<int>(0.5 * eyes_deg / profile_.zone.cone_deg * profile_.views);
    return PanelLight{*optics, sheet_, {}, profile_.views, std::max(1, own)};
  }

 private:
  /// The leading bits of a step.
  static float coarse(double step) {
    int exponent = 0;
    const double mantissa = std::frexp(step, &exponent);
    return static_cast<float>(std::ldexp(std::round(std::ldexp(mantissa, kCoarseBits)), exponent - kCoarseBits));
  }

  PanelProfile profile_;
  LensSheet sheet_;
  ViewFilter filter_;
  ViewFocus focus_;
  Screen screen_;
  std::vector<View> views_;
  ComposePass pass_{"lens_views.frag"};
};

class TrackedSink : public OutputSink {
 public:
  TrackedSink(PanelProfile profile, const TrackedPanel& panel, bool right_first)
      : profile_(std::move(profile)), panel_(panel), right_first_(right_first), screen_(panel_screen(profile_, {})) {}

  SinkTraits traits() const noexcept override {
    const PixelSize window{screen_.window_w, screen_.window_h};
    // A lens shows each eye about half of the subpixels: half the panel's width is enough.
    return {.name = "lenticular",
            .views = 2,
            .view = {(window.width + 1) / 2, window.height},
            .output = window,
            .tracked = true,
            .own_pixels = true,
            .own_size = true,
            .exact_pixels = true};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    screen_ = panel_screen(profile_, screen);
    return {};
  }
  std::span<const View> views(const Observer& viewer) override {
    // Light goes to the true eyes, whatever the factors.
    eyes_ = {glm::vec3(right_first_ ? viewer.right_mm : viewer.left_mm),
             glm::vec3(right_first_ ? viewer.left_mm : viewer.right_mm)};
    return views_ = stereo_views(screen_, viewer);
  }
  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    const LensOptics& lens = panel_.lens;
    DUBSAR_TRY(pass_.begin(target, views.coded()));
    set_window(screen_);
    glUniform2i(kPanelPx, panel_.width_px, panel_.height_px);
    glUniform2f(kPixelMm, static_cast<float>(lens.pixel_mm.x), static_cast<float>(lens.pixel_mm.y));
    glUniform4f(kLens, static_cast<float>(lens.pitch_mm), static_cast<float>(lens.tan_slant),
                static_cast<float>(lens.reduced_gap_mm),
                static_cast<float>(1.0 - 1.0 / (lens.refractive_index * lens.refractive_index)));
    glUniform1f(kPhase0, static_cast<float>(lens.phase0));
    glUniform3fv(kEyes, 2, glm::value_ptr(eyes_[0]));
    const auto offsets = flat_offsets(panel_.subpixels);
    glUniform2fv(kTrackedOffsets, 3, glm::value_ptr(offsets[0]));
    return pass_.draw();
  }
  std::optional<PanelLight> light() const override {
    return PanelLight{panel_, std::nullopt, {glm::dvec3(eyes_[0]), glm::dvec3(eyes_[1])}, 2, 0};
  }

 private:
  PanelProfile profile_;
  TrackedPanel panel_;
  bool right_first_;  ///< layer 0 is for the right eye
  Screen screen_;
  std::array<View, 2> views_;
  std::array<glm::vec3, 2> eyes_{glm::vec3(Observer().left_mm), glm::vec3(Observer().right_mm)};  ///< of layers 0 and 1
  ComposePass pass_{"lens_tracked.frag"};
};

}  // namespace

Result<std::unique_ptr<OutputSink>> make_lenticular_sink(SinkOptions options) {
  constexpr std::string_view kPanels = "panel=PROFILE and/or calibration=FILE";
  constexpr std::string_view kOfViews = "nearest, linear, gaussian3 or gaussian10, focus=, zoom=";
  constexpr std::string_view kOfTracked = "left_first or right_first";
  constexpr std::array<ViewFilter, 5> kFilters{ViewFilter::kLinear, ViewFilter::kLinear, ViewFilter::kNearest,
                                               ViewFilter::kGaussian3, ViewFilter::kGaussian10};
  const int filter = options.choice({"", "linear", "nearest", "gaussian3", "gaussian10"});  // 0: none was given
  const int order = options.choice({"", "left_first", "right_first"});
  DUBSAR_ASSIGN(auto panel_choice, options.panel());
  if (!panel_choice) return fail(ErrorKind::kUsage, "display lenticular: no panel was named, expected {}", kPanels);
  PanelProfile profile = *std::move(panel_choice);
  if (profile.kind == PanelKind::kTracked) {
    if (filter != 0)
      return fail(ErrorKind::kUsage,
                  "display lenticular: panel {} weaves two views and filters none, expected {} and no filter",
                  profile.name, kOfTracked);
    DUBSAR_TRY(options.finish(fmt::format("{}, {}", kPanels, kOfTracked)));
    DUBSAR_ASSIGN(const TrackedPanel panel, panel_optics(profile, profile.zone.design_distance_mm));
    if (panel.subpixels.cells.size() != 1)
      return fail(ErrorKind::kConfig, "display lenticular: panel {} has {} subpixel cells, expected 1 for tracked eyes",
                  profile.name, panel.subpixels.cells.size());
    return std::make_unique<TrackedSink>(std::move(profile), panel, order == 2);
  }
  const ViewFocus focus = options.focus();
  DUBSAR_TRY(options.finish(fmt::format("{}, {}", kPanels, kOfViews)));
  if (order != 0)
    return fail(
        ErrorKind::kUsage,
        "display lenticular: panel {} has {} views in the order that its calibration says (invView), expected no "
        "left_first or right_first",
        profile.name, profile.views);
  if (!profile.sheet)
    return fail(ErrorKind::kConfig,
                "display lenticular: no lens figures of panel {} are known, expected calibration=FILE", profile.name);
  if (profile.sheet->cells.size() > kMaxCells)
    return fail(ErrorKind::kConfig, "display lenticular: {} subpixel cells found, expected at most {}",
                profile.sheet->cells.size(), kMaxCells);
  if (profile.quilt.views() > 0) profile.views = profile.quilt.views();
  return std::make_unique<ViewsSink>(std::move(profile), kFilters[static_cast<std::size_t>(filter)], focus);
}

}  // namespace dubsar
