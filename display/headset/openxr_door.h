#pragma once
// The one door through which every call to an OpenXR runtime goes. Runtimes are other people's code in our process:
// some leave GL errors behind, some make another GL context current, some refuse calls when errors of ours wait.

#include "display/headset/openxr_api.h"

namespace dubsar::openxr {

/// One thread, that of the GL context. Before bind_context() calls are passed on as they are.
class Door {
 public:
  /// From now on the GL context that is current, of EGL or of GLX, is current after every call, too.
  void bind_context();

  /// Calls `function`. GL errors that wait before it are ours (take_own_error()); those that it leaves are dropped.
  template <class Function, class... Arguments>
  XrResult operator()(Function function, Arguments... arguments) {
    enter();
    const XrResult result = function(arguments...);
    leave();
    return result;
  }

  /// The first GL error that was there before a call, since the last take; GL_NO_ERROR: none.
  GLenum take_own_error() noexcept { return std::exchange(own_error_, GL_NO_ERROR); }

 private:
  struct Egl {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLSurface draw = EGL_NO_SURFACE, read = EGL_NO_SURFACE;
    EGLContext context = EGL_NO_CONTEXT;
  };
  struct Glx {
    Display* display = nullptr;
    GLXDrawable draw = 0, read = 0;
    GLXContext context = nullptr;
  };
  void enter() noexcept;
  void leave() noexcept;
  void put_back() noexcept;

  Egl egl_;
  Glx glx_;
  GLenum own_error_ = GL_NO_ERROR;
};

}  // namespace dubsar::openxr
