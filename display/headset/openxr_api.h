#pragma once
// What the sources of this folder share of OpenXR; nobody else includes it. The words of X11 and EGL stop here.

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <epoxy/glx.h>

#include <ctime>

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_XLIB
#define XR_USE_PLATFORM_EGL
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#undef Success
#undef None
#undef Status
#undef Bool

#include <string>

#include "core/base/numbers/pose.h"
#include "core/base/result.h"

namespace dubsar::openxr {

/// "XR_ERROR_...", without asking a runtime that may be gone.
std::string name_of(XrResult result);

/// kUnavailable with what was tried and what came back; success where the result is one.
Result<void> check(XrResult result, const char* tried);

template <class T>
T made(XrStructureType type) {
  T out{};
  out.type = type;
  return out;
}

inline Pose pose_of(const XrPosef& pose) {
  return {{pose.position.x, pose.position.y, pose.position.z},
          glm::normalize(glm::dquat(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z))};
}

/// An extension's function, or null.
template <class Function>
Function function_of(XrInstance instance, const char* name) {
  PFN_xrVoidFunction out = nullptr;
  if (XR_FAILED(xrGetInstanceProcAddr(instance, name, &out))) return nullptr;
  return reinterpret_cast<Function>(out);
}

}  // namespace dubsar::openxr
