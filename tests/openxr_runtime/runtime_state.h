#pragma once
// What the sources of the made runtime share.

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <epoxy/glx.h>
#include <vulkan/vulkan_core.h>

#include <ctime>

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_PLATFORM_XLIB
#define XR_USE_PLATFORM_EGL
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <deque>
#include <map>
#include <memory>
#include <string>

#include "tests/openxr_runtime/made_headset.h"

namespace dubsar::testing {

enum class SpaceKind { kLocal, kStage, kView, kGrip };
struct MadeSpace {
  SpaceKind kind = SpaceKind::kLocal;
  int side = 0;
};
struct MadeSwapchain {
  std::array<unsigned, 3> textures{};  // of sessions of OpenGL
  std::array<VkImage, 3> images{};     // of sessions of Vulkan
  std::array<VkDeviceMemory, 3> memory{};
  int width = 0, height = 0, next = 0, shown = -1;
  bool acquired = false, waited = false;
};
struct MadeAction {
  std::string name;
  XrActionType type = XR_ACTION_TYPE_POSE_INPUT;
};

/// Where the application is between xrWaitFrame and xrEndFrame.
struct FrameState {
  bool waited = false, begun = false;
  std::int64_t number = 0;  // of the one that was waited for
};

/// What the application is told of its session.
struct SessionNews {
  std::deque<XrSessionState> news;
  XrSessionState told = XR_SESSION_STATE_UNKNOWN;  // the newest that it took
  std::int64_t recentred_at = 0;                   // the frame of the new middle
  bool loss_told = false;
};

/// One instance, one session, as runtimes have it.
struct RuntimeState {
  MadeHeadset headset;
  SessionNews events;
  std::map<std::uint64_t, MadeSpace> spaces;
  std::map<std::uint64_t, MadeSwapchain> swapchains;
  std::map<std::uint64_t, MadeAction> actions;
  std::map<std::uint64_t, int> trackers;  // side
  std::map<std::string, XrPath> paths;
  std::uint64_t next_handle = 1, session = 0, instance = 0;
  bool only_seen_hands = false;  // what the hand trackers were made for
  bool running = false;
  FrameState frame;
  bool vulkan = false;  // the session's pictures are Vulkan's
};

RuntimeState& state();

/// What the runtime's manners leave behind after a call; call it last.
void leave_traces(const char* call);

/// From one picture of the headset to the next; call under its mutex.
inline std::int64_t period_ns(const MadeHeadset& headset) {
  return static_cast<std::int64_t>(1e9 / headset.wearer.refresh_hz);
}

template <class Handle>
std::uint64_t id_of(Handle handle) {
  return reinterpret_cast<std::uint64_t>(handle);
}
template <class Handle>
Handle handle_of(std::uint64_t id) {
  return reinterpret_cast<Handle>(id);  // NOLINT(performance-no-int-to-ptr): handles are numbers here
}

XrPosef posef(const MadePose& pose);
MadePose in_space(const MadePose& local_from_thing, const MadeSpace& base, double time_s);
MadePose place_of(const MadeSpace& space, double time_s);
/// The session is lost from the moment that a test wants it to be.
bool session_lost();

// Sessions of Vulkan, with the device of the application (runtime_vulkan.cpp).
XrResult bind_vulkan(const XrGraphicsBindingVulkan2KHR& binding);
void unbind_vulkan();
XrResult make_vulkan_images(MadeSwapchain& chain, std::int64_t format);
void destroy_vulkan_images(MadeSwapchain& chain);
/// RGBA of the picture that is shown, rows from below.
std::vector<std::uint8_t> read_vulkan_image(const MadeSwapchain& chain);
PFN_xrVoidFunction vulkan_function(const std::string& name);

/// Hands and actions by their names, for xrGetInstanceProcAddr; null: not theirs.
PFN_xrVoidFunction input_function(const std::string& name);

}  // namespace dubsar::testing
