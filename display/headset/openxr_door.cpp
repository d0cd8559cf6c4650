#include "display/headset/openxr_door.h"

#include <mutex>

#include "core/base/system/log.h"

namespace dubsar::openxr {
namespace {

constexpr int kMostErrors = 64;  // flags of one context; a driver that never runs out of them is not waited for

GLenum drop_errors() noexcept {
  const GLenum first = glGetError();
  for (int i = 0; i < kMostErrors && first != GL_NO_ERROR && glGetError() != GL_NO_ERROR; ++i) {
  }
  return first;
}

}  // namespace

void Door::bind_context() {
  egl_ = {};
  glx_ = {};
  if (const EGLContext context = eglGetCurrentContext(); context != EGL_NO_CONTEXT) {
    egl_ = {eglGetCurrentDisplay(), eglGetCurrentSurface(EGL_DRAW), eglGetCurrentSurface(EGL_READ), context};
    return;
  }
  if (const GLXContext context = glXGetCurrentContext(); context != nullptr)
    glx_ = {glXGetCurrentDisplay(), glXGetCurrentDrawable(), glXGetCurrentReadDrawable(), context};
}

void Door::put_back() noexcept {
  bool moved = false;
  if (egl_.context != EGL_NO_CONTEXT && eglGetCurrentContext() != egl_.context) {
    moved = true;
    eglMakeCurrent(egl_.display, egl_.draw, egl_.read, egl_.context);
  } else if (glx_.context != nullptr && glXGetCurrentContext() != glx_.context) {
    moved = true;
    glXMakeContextCurrent(glx_.display, glx_.draw, glx_.read, glx_.context);
  }
  static std::once_flag told;
  if (moved)
    std::call_once(told, [] { log_info("openxr: the runtime makes other GL contexts current; ours is put back"); });
}

void Door::enter() noexcept {
  if (egl_.context == EGL_NO_CONTEXT && glx_.context == nullptr) return;
  put_back();  // a thread of the runtime cannot take it, a callback can
  if (const GLenum error = drop_errors(); own_error_ == GL_NO_ERROR) own_error_ = error;
}

void Door::leave() noexcept {
  if (egl_.context == EGL_NO_CONTEXT && glx_.context == nullptr) return;
  put_back();
  const GLenum error = drop_errors();
  static std::once_flag told;
  if (error != GL_NO_ERROR)
    std::call_once(told, [&] {
      log_info("openxr: the runtime leaves GL errors behind (the first is 0x{:04x}); they are dropped", error);
    });
}

}  // namespace dubsar::openxr
