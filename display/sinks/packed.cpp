#include "display/sinks/packed.h"

#include <algorithm>

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/copy_locations.h"
#include "display/sinks/stereo_views.h"

namespace dubsar {
namespace {

constexpr int kGapFraction = 24;  // HDMI 1.4a, 3D frame packing: 45 lines for 1080, 30 for 720

class PackedSink : public OutputSink {
 public:
  explicit PackedSink(const Packing& packing) : packing_(packing) {}

  SinkTraits traits() const noexcept override {
    return {.name = packing_.vertical ? "top_bottom" : "side_by_side",
            .views = 2,
            .view = packing_.view_size(window()),
            .output = packing_.output_size(window()),
            .tracked = true,
            .aspect = static_cast<double>(window().width) / window().height};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    if (!packing_.full && (packing_.vertical ? screen.window_h : screen.window_w) < 2)
      return fail(ErrorKind::kUsage, "display {}: a window of {} x {} pixels cannot be halved", traits().name,
                  screen.window_w, screen.window_h);
    screen_ = screen;
    return {};
  }
  std::span<const View> views(const Observer& viewer) override { return views_ = stereo_views(screen_, viewer); }

  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const PixelSize size = packing_.view_size(window());
    for (int eye = 0; eye < 2; ++eye) {
      const PixelSize corner = packing_.place(window(), eye);
      const int bottom = target.height - corner.height - size.height;
      DUBSAR_TRY(copy_.begin(target, views.coded()));
      glViewport(corner.width, bottom, size.width, size.height);
      glUniform1i(kLayerLocation, eye);
      glUniform2i(kOriginLocation, corner.width, bottom);
      DUBSAR_TRY(copy_.draw());
    }
    return {};
  }

 private:
  PixelSize window() const noexcept { return {screen_.window_w, screen_.window_h}; }
  Packing packing_;
  Screen screen_;
  std::array<View, 2> views_;
  ComposePass copy_{"copy.frag"};
};

Result<std::unique_ptr<OutputSink>> make_packed(SinkOptions options, Packing packing, std::string_view known) {
  packing.right_first = options.eyes_swapped();
  const int size =
      packing.vertical ? options.choice({"half", "full", "frame_packing"}) : options.choice({"half", "full"});
  packing.full = size >= 1;
  packing.frame_packing = size == 2;
  DUBSAR_TRY(options.finish(known));
  if (packing.frame_packing && packing.right_first)
    return fail(ErrorKind::kUsage,
                "display top_bottom: frame_packing with right_first found, expected left_first: the standard has the "
                "left view on top");
  return std::make_unique<PackedSink>(packing);
}

}  // namespace

PixelSize Packing::view_size(PixelSize window) const noexcept {
  if (full) return window;
  return vertical ? PixelSize{window.width, window.height / 2} : PixelSize{window.width / 2, window.height};
}

PixelSize Packing::output_size(PixelSize window) const noexcept {
  if (!full) return window;
  if (!vertical) return {2 * window.width, window.height};
  return {window.width, 2 * window.height + (frame_packing ? window.height / kGapFraction : 0)};
}

PixelSize Packing::place(PixelSize window, int eye) const noexcept {
  if ((eye == 1) == right_first) return {0, 0};
  const PixelSize view = view_size(window), output = output_size(window);
  // The second view is flush with the far side: an odd window leaves its spare line between the two.
  return vertical ? PixelSize{0, output.height - view.height} : PixelSize{output.width - view.width, 0};
}

Result<std::unique_ptr<OutputSink>> make_side_by_side_sink(SinkOptions options) {
  return make_packed(std::move(options), {.vertical = false}, "half or full, left_first or right_first");
}

Result<std::unique_ptr<OutputSink>> make_top_bottom_sink(SinkOptions options) {
  return make_packed(std::move(options), {.vertical = true}, "half, full or frame_packing, left_first or right_first");
}

}  // namespace dubsar
