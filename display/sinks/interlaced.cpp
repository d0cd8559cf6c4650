#include "display/sinks/interlaced.h"

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/stereo_views.h"

namespace dubsar {
namespace {

constexpr GLint kPatternLocation = 0, kPanelOriginLocation = 1, kFirstLocation = 2;  // shaders/interlaced.frag

class InterlacedSink : public OutputSink {
 public:
  InterlacedSink(InterlacePattern pattern, bool right_first, bool from_bottom)
      : pattern_(pattern), right_first_(right_first), from_bottom_(from_bottom) {}

  SinkTraits traits() const noexcept override {
    const PixelSize size{screen_.window_w, screen_.window_h};
    return {.name = "interlaced", .views = 2, .view = size, .output = size, .tracked = true, .exact_pixels = true};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    screen_ = screen;
    return {};
  }
  std::span<const View> views(const Observer& viewer) override { return views_ = stereo_views(screen_, viewer); }

  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    DUBSAR_TRY(pass_.begin(target, views.coded()));
    glUniform1i(kPatternLocation, static_cast<int>(pattern_));
    glUniform3i(kPanelOriginLocation, screen_.window_x, screen_.window_y, screen_.window_h);
    const bool exchanged = from_bottom_ && bottom_exchanges(pattern_, screen_.height_px);
    glUniform1i(kFirstLocation, right_first_ != exchanged ? 1 : 0);
    return pass_.draw();
  }

 private:
  InterlacePattern pattern_;
  bool right_first_, from_bottom_;
  Screen screen_;
  std::array<View, 2> views_;
  ComposePass pass_{"interlaced.frag"};
};

}  // namespace

bool bottom_exchanges(InterlacePattern pattern, int panel_height) noexcept {
  return (pattern == InterlacePattern::kRows || pattern == InterlacePattern::kCheckerboard) && panel_height % 2 == 0;
}

Result<std::unique_ptr<OutputSink>> make_interlaced_sink(SinkOptions options) {
  const bool right_first = options.eyes_swapped();
  const auto pattern = static_cast<InterlacePattern>(options.choice({"rows", "columns", "checkerboard", "subpixels"}));
  const bool has_rows = pattern == InterlacePattern::kRows || pattern == InterlacePattern::kCheckerboard;
  const bool from_bottom = has_rows && options.choice({"top", "bottom"}) == 1;
  DUBSAR_TRY(options.finish(has_rows
                                ? "rows, columns, checkerboard or subpixels, left_first or right_first, top or bottom"
                                : "rows, columns, checkerboard or subpixels, left_first or right_first"));
  return std::make_unique<InterlacedSink>(pattern, right_first, from_bottom);
}

}  // namespace dubsar
