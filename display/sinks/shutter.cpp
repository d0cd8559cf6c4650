#include "display/sinks/shutter.h"

#include <array>

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/copy_locations.h"
#include "display/sinks/stereo_views.h"

namespace dubsar {
namespace {

class ShutterSink : public OutputSink {
 public:
  explicit ShutterSink(bool right_first) : right_first_(right_first) {}

  SinkTraits traits() const noexcept override {
    const PixelSize size{screen_.window_w, screen_.window_h};
    return {.name = "shutter", .views = 2, .view = size, .output = size, .tracked = true, .fields = 2};
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    screen_ = screen;
    return {};
  }
  std::span<const View> views(const Observer& viewer) override { return views_ = stereo_views(screen_, viewer); }

  Result<void> compose(const ViewArray& views, const Surface& target, Field field) override {
    DUBSAR_TRY(copy_.begin(target, views.coded()));
    glUniform1i(kLayerLocation, (field == Field::kSecond) != right_first_ ? 1 : 0);
    glUniform2i(kOriginLocation, 0, 0);
    return copy_.draw();
  }

 private:
  bool right_first_;
  Screen screen_;
  std::array<View, 2> views_;
  ComposePass copy_{"copy.frag"};
};

}  // namespace

Result<std::unique_ptr<OutputSink>> make_shutter_sink(SinkOptions options) {
  const bool right_first = options.eyes_swapped();
  DUBSAR_TRY(options.finish("left_first or right_first"));
  return std::make_unique<ShutterSink>(right_first);
}

}  // namespace dubsar
