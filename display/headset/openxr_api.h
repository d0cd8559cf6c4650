#pragma once
// What the sources of this folder share of OpenXR; nobody else includes it. The words of X11 and EGL stop here.

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <epoxy/glx.h>

#include <ctime>

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_GRAPHICS_API_VULKAN
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
#include <utility>

#include "core/base/numbers/pose.h"
#include "core/base/result.h"

// Newer than the headers of Debian 12; values and members are those of Khronos' registry.
#ifndef XR_EXT_hand_tracking_data_source
#define XR_EXT_hand_tracking_data_source 1
#define XR_EXT_HAND_TRACKING_DATA_SOURCE_EXTENSION_NAME "XR_EXT_hand_tracking_data_source"
// NOLINTBEGIN(readability-identifier-naming)
inline constexpr auto XR_TYPE_HAND_TRACKING_DATA_SOURCE_INFO_EXT = static_cast<XrStructureType>(1000428000);
inline constexpr auto XR_TYPE_HAND_TRACKING_DATA_SOURCE_STATE_EXT = static_cast<XrStructureType>(1000428001);
enum XrHandTrackingDataSourceEXT : std::int32_t {
  XR_HAND_TRACKING_DATA_SOURCE_UNOBSTRUCTED_EXT = 1,
  XR_HAND_TRACKING_DATA_SOURCE_CONTROLLER_EXT = 2,
};
struct XrHandTrackingDataSourceInfoEXT {
  XrStructureType type;
  const void* next;
  std::uint32_t requestedDataSourceCount;
  XrHandTrackingDataSourceEXT* requestedDataSources;
};
struct XrHandTrackingDataSourceStateEXT {
  XrStructureType type;
  void* next;
  XrBool32 isActive;
  XrHandTrackingDataSourceEXT dataSource;
};
// NOLINTEND(readability-identifier-naming)
#endif

namespace dubsar::openxr {

inline constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;

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
