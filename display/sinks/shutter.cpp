#include "display/sinks/shutter.h"

#include <array>

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/copy_locations.h"
#include "display/sinks/two_view_sink.h"

namespace dubsar {
namespace {

class ShutterSink : public TwoViewSink {
 public:
  explicit ShutterSink(bool right_first) : TwoViewSink({.name = "shutter", .fields = 2}, right_first) {}

  Result<void> compose(const ViewArray& views, const Surface& target, Field field) override {
    DUBSAR_TRY(copy_.begin(target, views.coded()));
    glUniform1i(kLayerLocation, (field == Field::kSecond) != right_first() ? 1 : 0);
    glUniform2i(kOriginLocation, 0, 0);
    return copy_.draw();
  }

 private:
  ComposePass copy_{"copy.frag"};
};

}  // namespace

Result<std::unique_ptr<OutputSink>> make_shutter_sink(SinkOptions options) {
  const bool right_first = options.eyes_swapped();
  DUBSAR_TRY(options.finish("left_first or right_first"));
  return std::make_unique<ShutterSink>(right_first);
}

}  // namespace dubsar
