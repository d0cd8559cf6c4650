#include "display/sinks/interlaced.h"

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/two_view_sink.h"

namespace dubsar {
namespace {

constexpr GLint kPatternLocation = 0, kPanelOriginLocation = 1, kFirstLocation = 2;  // shaders/interlaced.frag

class InterlacedSink : public TwoViewSink {
 public:
  InterlacedSink(InterlacePattern pattern, bool right_first, bool from_bottom)
      : TwoViewSink({.name = "interlaced", .exact_pixels = true}, right_first),
        pattern_(pattern),
        from_bottom_(from_bottom) {}

  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    DUBSAR_TRY(pass_.begin(target, views.coded()));
    glUniform1i(kPatternLocation, static_cast<int>(pattern_));
    glUniform3i(kPanelOriginLocation, screen().window_x, screen().window_y, screen().window_h);
    const bool exchanged = from_bottom_ && bottom_exchanges(pattern_, screen().height_px);
    glUniform1i(kFirstLocation, right_first() != exchanged ? 1 : 0);
    return pass_.draw();
  }

 private:
  InterlacePattern pattern_;
  bool from_bottom_;
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
