#include "display/sinks/mono.h"

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"

namespace dubsar {
namespace {

class MonoSink : public OutputSink {
 public:
  explicit MonoSink(bool draws) : draws_(draws) {}

  SinkTraits traits() const noexcept override {
    const PixelSize size{screen_.window_w, screen_.window_h};
    return {.name = draws_ ? "mono" : "null", .views = 1, .view = size, .output = size, .tracked = true};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    screen_ = screen;
    return {};
  }
  std::span<const View> views(const Observer& viewer) override {
    view_ = viewer_view(screen_.window_rect(), viewer, camera_pair(viewer).centre_mm());
    return {&view_, 1};
  }
  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    if (!draws_) return {};
    return copy_.draw(views, 0, target);
  }

 private:
  bool draws_;
  Screen screen_;
  View view_;
  LayerCopy copy_;
};

}  // namespace

Result<std::unique_ptr<OutputSink>> make_mono_sink(SinkOptions options) {
  DUBSAR_TRY(options.finish("no options"));
  return std::make_unique<MonoSink>(true);
}

Result<std::unique_ptr<OutputSink>> make_null_sink(SinkOptions options) {
  DUBSAR_TRY(options.finish("no options"));
  return std::make_unique<MonoSink>(false);
}

}  // namespace dubsar
