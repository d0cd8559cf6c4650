#pragma once
// Drawing without a window: EGL without a surface, so no X server or Wayland session is needed.

#include <memory>

#include "display/render/context/gl_context.h"

namespace dubsar {

class EglContext final : public GlContext {
 public:
  /// A current GL 4.5 core context. Tries Mesa's surfaceless platform (which takes the GPU when there is one, else
  /// llvmpipe), then every EGL device. kUnavailable, with what to install, when none gives GL 4.5.
  static Result<std::unique_ptr<EglContext>> create();
  ~EglContext() override;
  Result<void> make_current() override;

 private:
  EglContext(void* display, void* context) : display_(display), context_(context) {}
  void* display_;
  void* context_;
};

}  // namespace dubsar
