#include "display/render/context/context_egl.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <string>
#include <vector>

#include "core/base/system/log.h"

namespace dubsar {
namespace {

constexpr int kMaxDevices = 16;

std::string egl_error_text() { return fmt::format("EGL error 0x{:04x}", static_cast<unsigned>(eglGetError())); }

struct Candidate {
  const char* name;
  EGLDisplay display;
};

std::vector<Candidate> candidates() {
  std::vector<Candidate> out;
  const bool platforms = epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base");
  if (platforms && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    out.push_back({"the surfaceless platform",
                   eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  if (platforms && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
    std::array<EGLDeviceEXT, kMaxDevices> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(kMaxDevices, devices.data(), &count))
      for (int i = 0; i < count; ++i)
        out.push_back({"an EGL device", eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
  }
  return out;
}

/// A current context on `display`, or EGL_NO_CONTEXT and the reason.
EGLContext try_display(EGLDisplay display, std::string& reason) {
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
    reason = "no display, " + egl_error_text();
    return EGL_NO_CONTEXT;
  }
  if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context") || !eglBindAPI(EGL_OPENGL_API)) {
    reason = "it has no surfaceless OpenGL contexts";
    return EGL_NO_CONTEXT;
  }
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
    constexpr std::array<EGLint, 5> kWanted{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, kWanted.data(), &config, 1, &count) || count == 0) {
      reason = "it has no OpenGL configuration";
      return EGL_NO_CONTEXT;
    }
  }
  constexpr std::array<EGLint, 9> kAttributes{EGL_CONTEXT_MAJOR_VERSION,
                                              4,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              5,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              EGL_CONTEXT_OPENGL_DEBUG,
                                              EGL_FALSE,
                                              EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, kAttributes.data());
  if (context == EGL_NO_CONTEXT) {
    reason = "it has no GL 4.5 core context, " + egl_error_text();
    return EGL_NO_CONTEXT;
  }
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) && has_gl45()) return context;
  reason = "its context cannot be used, " + egl_error_text();
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display, context);
  return EGL_NO_CONTEXT;
}

}  // namespace

Result<std::unique_ptr<EglContext>> EglContext::create() {
  if (!epoxy_has_egl())
    return fail(ErrorKind::kUnavailable,
                "gl: libEGL.so.1 was not found; install libegl1, libegl-mesa0 and libgl1-mesa-dri");
  std::string reasons;
  for (const Candidate& candidate : candidates()) {
    std::string reason;
    const EGLContext context = try_display(candidate.display, reason);
    if (context == EGL_NO_CONTEXT) {
      reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", candidate.name, reason);
      continue;
    }
    std::unique_ptr<EglContext> made(new EglContext(candidate.display, context));
    log_gl_messages();
    log_debug("gl: {} through {}", describe_gl(), candidate.name);
    return made;
  }
  return fail(
      ErrorKind::kUnavailable,
      "gl: no offscreen OpenGL 4.5 context could be made ({}); install libegl-mesa0 and libgl1-mesa-dri, or the "
      "driver of your graphics card",
      reasons.empty() ? "EGL offers neither the surfaceless platform nor a device" : reasons);
}

// The EGLDisplay itself is shared by the whole process and stays initialised.
EglContext::~EglContext() {
  if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

Result<void> EglContext::make_current() {
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) return {};
  return fail(ErrorKind::kUnavailable, "gl: the offscreen context cannot be made current, {}", egl_error_text());
}

}  // namespace dubsar
