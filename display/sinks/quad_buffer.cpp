#include "display/sinks/quad_buffer.h"

#include <algorithm>

#include "display/render/passes/compose_pass.h"
#include "display/render/view_array.h"
#include "display/sinks/copy_locations.h"
#include "display/sinks/two_view_sink.h"

namespace dubsar {
namespace {

class QuadBufferSink : public TwoViewSink {
 public:
  explicit QuadBufferSink(bool right_first)
      : TwoViewSink({.name = "quad_buffer", .stereo_visual = true}, right_first) {}

  Result<void> compose(const ViewArray& views, const Surface& target, Field) override {
    if (std::count(target.eye_buffers.begin(), target.eye_buffers.end(), 0u) != 0)
      return fail(ErrorKind::kUnavailable,
                  "display quad_buffer: this window has one buffer, expected one for each eye (a stereo visual)");
    for (std::size_t eye = 0; eye < 2; ++eye) {
      DUBSAR_TRY(copy_.begin(target, views.coded()));
      glDrawBuffer(target.eye_buffers[eye]);
      glUniform1i(kLayerLocation, static_cast<GLint>(right_first() ? 1 - eye : eye));
      glUniform2i(kOriginLocation, 0, 0);
      DUBSAR_TRY(copy_.draw());
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glDrawBuffer(target.framebuffer == 0 ? GL_BACK : target.eye_buffers[0]);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return check_gl("composing for two eyes");
  }

 private:
  ComposePass copy_{"copy.frag"};
};

}  // namespace

Result<std::unique_ptr<OutputSink>> make_quad_buffer_sink(SinkOptions options) {
  const bool right_first = options.eyes_swapped();
  DUBSAR_TRY(options.finish("left_first or right_first"));
  return std::make_unique<QuadBufferSink>(right_first);
}

}  // namespace dubsar
