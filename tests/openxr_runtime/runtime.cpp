// The instance, the session, spaces and frames of the made runtime.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/openxr_runtime/runtime_state.h"

namespace dubsar::testing {

RuntimeState& state() {
  static RuntimeState the;
  return the;
}

XrPosef posef(const MadePose& p) {
  return {{static_cast<float>(p.rotation.x), static_cast<float>(p.rotation.y), static_cast<float>(p.rotation.z),
           static_cast<float>(p.rotation.w)},
          {static_cast<float>(p.position.x), static_cast<float>(p.position.y), static_cast<float>(p.position.z)}};
}

MadePose place_of(const MadeSpace& space, double t) {
  const MadeHeadset& h = state().headset;
  switch (space.kind) {
    case SpaceKind::kLocal:
      return {};
    case SpaceKind::kStage:
      return {{0.4, h.wearer.floor_m, 0.2}, glm::angleAxis(0.6, glm::dvec3(0, 1, 0))};  // somewhere else, turned
    case SpaceKind::kView:
      return made_head(h, t);
    case SpaceKind::kGrip:
      return h.hands.grip;
  }
  return {};
}

MadePose in_space(const MadePose& thing, const MadeSpace& base, double t) {
  const MadePose frame = place_of(base, t);
  const glm::dquat back = glm::conjugate(frame.rotation);
  return {back * (thing.position - frame.position), back * thing.rotation};
}

void leave_traces(const char* call) {
  const MadeManners& manners = state().headset.manners;
  if (manners.gl_error_after == call) glEnable(0x1234);
  if (manners.context_taken_by != call) return;
  if (const EGLDisplay egl = eglGetCurrentDisplay(); egl != EGL_NO_DISPLAY)
    eglMakeCurrent(egl, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  else if (Display* const glx = glXGetCurrentDisplay(); glx != nullptr)
    glXMakeCurrent(glx, 0, nullptr);
}

bool session_lost() { return state().headset.faults.lose_session || state().headset.faults.end_instance; }

namespace {

std::vector<const char*> extensions() {
  const MadeManners& manners = state().headset.manners;
  std::vector<const char*> out;
  if (!manners.lacks.vulkan) out.push_back(XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME);
  if (!manners.lacks.gl) out.push_back(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  if (!manners.lacks.egl) out.push_back(XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
  if (!manners.lacks.hands) out.push_back(XR_EXT_HAND_TRACKING_EXTENSION_NAME);
  if (manners.hand_source) out.push_back("XR_EXT_hand_tracking_data_source");
  if (!manners.lacks.time) out.push_back(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  return out;
}
constexpr std::array<float, 4> kFov{-0.78f, 0.70f, 0.74f, -0.83f};  // left, right, up, down; the other eye mirrored

std::array<float, 4> fov_of(int eye) {
  return eye == 0 ? kFov : std::array<float, 4>{-kFov[1], -kFov[0], kFov[2], kFov[3]};
}

template <class T>
XrResult fill(const std::vector<T>& all, std::uint32_t capacity, std::uint32_t* count, T* out) {
  *count = static_cast<std::uint32_t>(all.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < all.size()) return XR_ERROR_SIZE_INSUFFICIENT;
  std::copy(all.begin(), all.end(), out);
  return XR_SUCCESS;
}

XrResult wrong() {
  ++state().headset.wrong_calls;
  return XR_ERROR_CALL_ORDER_INVALID;
}

XrResult XRAPI_CALL enumerate_extensions(const char*, std::uint32_t capacity, std::uint32_t* count,
                                         XrExtensionProperties* out) {
  const auto names = extensions();
  *count = static_cast<std::uint32_t>(names.size());
  for (std::size_t i = 0; capacity != 0 && i < names.size(); ++i) {
    std::strncpy(out[i].extensionName, names[i], XR_MAX_EXTENSION_NAME_SIZE - 1);
    out[i].extensionVersion = 1;
  }
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_instance(const XrInstanceCreateInfo* info, XrInstance* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (std::getenv("DUBSAR_MADE_RUNTIME_ABORTS") != nullptr) std::abort();
  if (s.headset.manners.lacks.newer_api && info->applicationInfo.apiVersion >= XR_MAKE_VERSION(1, 0, 1))
    return XR_ERROR_API_VERSION_UNSUPPORTED;
  if (s.headset.alive.instances != 0) return XR_ERROR_LIMIT_REACHED;
  if (s.headset.faults.end_instance) return XR_ERROR_RUNTIME_UNAVAILABLE;
  ++s.headset.alive.instances;
  ++s.headset.instances_ever;
  s.instance = s.next_handle++;
  *out = handle_of<XrInstance>(s.instance);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL destroy_instance(XrInstance) {
  const std::lock_guard lock(state().headset.mutex);
  --state().headset.alive.instances;
  return XR_SUCCESS;
}
XrResult XRAPI_CALL instance_properties(XrInstance, XrInstanceProperties* out) {
  out->runtimeVersion = XR_MAKE_VERSION(1, 2, 3);
  std::strcpy(out->runtimeName, "Made Runtime");
  return XR_SUCCESS;
}
XrResult XRAPI_CALL poll_event(XrInstance, XrEventDataBuffer* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (s.headset.faults.end_instance) return XR_ERROR_INSTANCE_LOST;
  if (s.headset.faults.lose_session && s.session != 0 && !s.events.loss_told) {
    s.events.loss_told = true;
    s.events.news.push_back(XR_SESSION_STATE_LOSS_PENDING);
  }
  if (s.headset.faults.recentre) {
    s.headset.faults.recentre = false;
    auto& change = *reinterpret_cast<XrEventDataReferenceSpaceChangePending*>(out);
    change = {};
    change.type = XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING;
    change.session = handle_of<XrSession>(s.session);
    change.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
    s.events.recentred_at = s.frame.number + 1 + s.headset.manners.recentre_lead;
    change.changeTime = (s.events.recentred_at + 2) * period_ns(s.headset);
    leave_traces("xrPollEvent");
    return XR_SUCCESS;
  }
  for (const XrState next : s.headset.faults.states) s.events.news.push_back(static_cast<XrSessionState>(next));
  s.headset.faults.states.clear();
  leave_traces("xrPollEvent");
  if (s.events.news.empty()) return XR_EVENT_UNAVAILABLE;
  auto& change = *reinterpret_cast<XrEventDataSessionStateChanged*>(out);
  change = {};
  change.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED;
  change.session = handle_of<XrSession>(s.session);
  change.state = s.events.told = s.events.news.front();
  s.events.news.pop_front();
  return XR_SUCCESS;
}
XrResult XRAPI_CALL get_system(XrInstance, const XrSystemGetInfo* info, XrSystemId* out) {
  if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
  if (state().headset.faults.no_headset) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
  *out = 7;
  return XR_SUCCESS;
}
XrResult XRAPI_CALL system_properties(XrInstance, XrSystemId, XrSystemProperties* out) {
  std::strcpy(out->systemName, "Made Headset");
  for (auto* next = static_cast<XrBaseOutStructure*>(out->next); next != nullptr; next = next->next)
    if (next->type == XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT)
      reinterpret_cast<XrSystemHandTrackingPropertiesEXT*>(next)->supportsHandTracking = XR_TRUE;
  return XR_SUCCESS;
}
XrResult XRAPI_CALL view_sizes(XrInstance, XrSystemId, XrViewConfigurationType, std::uint32_t capacity,
                               std::uint32_t* count, XrViewConfigurationView* out) {
  XrViewConfigurationView view{};
  view.type = XR_TYPE_VIEW_CONFIGURATION_VIEW;
  view.recommendedImageRectWidth = view.recommendedImageRectHeight =
      static_cast<std::uint32_t>(state().headset.manners.eye_px);
  view.maxImageRectWidth = view.maxImageRectHeight = 4096;
  view.recommendedSwapchainSampleCount = view.maxSwapchainSampleCount = 1;
  return fill(std::vector(static_cast<std::size_t>(state().headset.manners.views), view), capacity, count, out);
}
XrResult XRAPI_CALL blend_modes(XrInstance, XrSystemId, XrViewConfigurationType, std::uint32_t capacity,
                                std::uint32_t* count, XrEnvironmentBlendMode* out) {
  std::vector<XrEnvironmentBlendMode> modes;
  for (const int mode : state().headset.manners.blends) modes.push_back(static_cast<XrEnvironmentBlendMode>(mode));
  return fill(modes, capacity, count, out);
}
XrResult XRAPI_CALL gl_requirements(XrInstance, XrSystemId, XrGraphicsRequirementsOpenGLKHR* out) {
  out->minApiVersionSupported = XR_MAKE_VERSION(4, 3, 0);
  out->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_session(XrInstance, const XrSessionCreateInfo* info, XrSession* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (s.session != 0) return XR_ERROR_LIMIT_REACHED;
  if (session_lost()) return XR_ERROR_RUNTIME_FAILURE;
  const auto* const binding = static_cast<const XrBaseInStructure*>(info->next);
  if (binding == nullptr) return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  s.vulkan = binding->type == XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR;
  if (s.headset.manners.lacks.gl_session && !s.vulkan) return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  if (s.vulkan) {
    const XrResult bound = bind_vulkan(*reinterpret_cast<const XrGraphicsBindingVulkan2KHR*>(binding));
    if (bound != XR_SUCCESS) return bound;
    s.headset.binding = "Vulkan";
  } else if (binding->type == XR_TYPE_GRAPHICS_BINDING_EGL_MNDX) {
    const auto& egl = *reinterpret_cast<const XrGraphicsBindingEGLMNDX*>(binding);
    if (egl.context == nullptr || egl.display == nullptr || egl.getProcAddress == nullptr)
      return XR_ERROR_GRAPHICS_DEVICE_INVALID;
    s.headset.binding = "EGL";
  } else if (binding->type == XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR) {
    const auto& glx = *reinterpret_cast<const XrGraphicsBindingOpenGLXlibKHR*>(binding);
    if (glx.xDisplay == nullptr || glx.glxContext == nullptr || glx.glxFBConfig == nullptr || glx.visualid == 0)
      return XR_ERROR_GRAPHICS_DEVICE_INVALID;
    s.headset.binding = "GLX";
  } else {
    return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  }
  s.session = s.next_handle++;
  s.running = s.frame.waited = s.frame.begun = s.events.loss_told = false;
  ++s.headset.alive.sessions;
  ++s.headset.sessions_ever;
  s.events.news = {XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY};
  *out = handle_of<XrSession>(s.session);
  leave_traces("xrCreateSession");
  return XR_SUCCESS;
}
XrResult XRAPI_CALL destroy_session(XrSession) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  --s.headset.alive.sessions;
  if (s.vulkan) unbind_vulkan();
  s.vulkan = false;
  s.session = 0;
  s.running = false;
  s.events.news.clear();
  return XR_SUCCESS;
}
XrResult XRAPI_CALL begin_session(XrSession, const XrSessionBeginInfo*) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (s.running) return wrong();
  s.running = true;
  for (const auto next : {XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED})
    s.events.news.push_back(next);
  leave_traces("xrBeginSession");
  return XR_SUCCESS;
}
XrResult XRAPI_CALL end_session(XrSession) {
  state().running = false;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_reference_space(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_STAGE && !s.headset.wearer.has_floor)
    return XR_ERROR_REFERENCE_SPACE_UNSUPPORTED;
  const SpaceKind kind = info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_STAGE  ? SpaceKind::kStage
                         : info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_VIEW ? SpaceKind::kView
                                                                                    : SpaceKind::kLocal;
  s.spaces[s.next_handle] = {kind, 0};
  ++s.headset.alive.spaces;
  *out = handle_of<XrSpace>(s.next_handle++);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL destroy_space(XrSpace space) {
  const std::lock_guard lock(state().headset.mutex);
  state().headset.alive.spaces -= static_cast<int>(state().spaces.erase(id_of(space)));
  return XR_SUCCESS;
}
XrResult XRAPI_CALL locate_space(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  const double t = 1e-9 * static_cast<double>(time);
  out->pose = posef(in_space(place_of(s.spaces[id_of(space)], t), s.spaces[id_of(base)], t));
  out->locationFlags = XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT |
                       XR_SPACE_LOCATION_POSITION_TRACKED_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
  leave_traces("xrLocateSpace");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL wait_frame(XrSession, const XrFrameWaitInfo*, XrFrameState* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (session_lost()) return XR_ERROR_SESSION_LOST;
  if (!s.running || s.frame.waited) return wrong();
  s.frame.waited = true;
  ++s.frame.number;  // time goes on by frames: a slow renderer sees the same world as a quick one
  out->predictedDisplayTime = (s.frame.number + 2) * period_ns(s.headset);
  out->predictedDisplayPeriod = period_ns(s.headset);
  out->shouldRender = s.headset.manners.hidden ? XR_FALSE : XR_TRUE;
  s.headset.now_s = 1e-9 * static_cast<double>(out->predictedDisplayTime);
  leave_traces("xrWaitFrame");
  return XR_SUCCESS;
}
XrResult XRAPI_CALL begin_frame(XrSession, const XrFrameBeginInfo*) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (!s.frame.waited || s.frame.begun) return wrong();
  s.frame.waited = false;
  s.frame.begun = true;
  leave_traces("xrBeginFrame");
  return XR_SUCCESS;
}
XrResult XRAPI_CALL locate_views(XrSession, const XrViewLocateInfo* info, XrViewState* view_state,
                                 std::uint32_t capacity, std::uint32_t* count, XrView* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  *count = static_cast<std::uint32_t>(s.headset.manners.views);
  if (capacity < *count) return capacity == 0 ? XR_SUCCESS : XR_ERROR_SIZE_INSUFFICIENT;
  const double t = 1e-9 * static_cast<double>(info->displayTime);
  const MadePose head = made_head(s.headset, t);
  for (int eye = 0; eye < 2; ++eye) {
    const double side = (eye == 0 ? -0.5 : 0.5) * s.headset.wearer.eyes_apart_m;
    const MadePose at{head.position + head.rotation * glm::dvec3(side, 0, 0), head.rotation};
    out[eye].pose = posef(in_space(at, s.spaces[id_of(info->space)], t));
    const auto fov = fov_of(eye);
    out[eye].fov = {fov[0], fov[1], fov[2], fov[3]};
  }
  view_state->viewStateFlags = XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT |
                               XR_VIEW_STATE_POSITION_TRACKED_BIT | XR_VIEW_STATE_ORIENTATION_TRACKED_BIT;
  leave_traces("xrLocateViews");
  return XR_SUCCESS;
}
XrResult XRAPI_CALL convert_time(XrInstance, XrTime time, timespec* out) {
  // The made time began at 0; what is displayed next is displayed one period from now.
  RuntimeState& s = state();
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t at =
      now.tv_sec * 1'000'000'000LL + now.tv_nsec + time - (s.frame.number + 1) * period_ns(s.headset);
  *out = {at / 1'000'000'000, at % 1'000'000'000};
  return XR_SUCCESS;
}

// Core functions, mandatory: layers of other people call them.
XrResult XRAPI_CALL type_text(XrInstance, XrStructureType value, char out[XR_MAX_STRUCTURE_NAME_SIZE]) {
  std::snprintf(out, XR_MAX_STRUCTURE_NAME_SIZE, "XR_TYPE_%d", static_cast<int>(value));
  return XR_SUCCESS;
}
XrResult XRAPI_CALL result_text(XrInstance, XrResult value, char out[XR_MAX_RESULT_STRING_SIZE]) {
  std::snprintf(out, XR_MAX_RESULT_STRING_SIZE, "XrResult_%d", static_cast<int>(value));
  return XR_SUCCESS;
}

}  // namespace

/// The functions of this file and of runtime_frames.cpp by their names.
PFN_xrVoidFunction frame_function(const std::string& name);

namespace {
template <class F>
PFN_xrVoidFunction plain(F* function) {
  return reinterpret_cast<PFN_xrVoidFunction>(function);
}

XrResult XRAPI_CALL get_proc(XrInstance, const char* name, PFN_xrVoidFunction* out) {
  static const std::map<std::string, PFN_xrVoidFunction> functions{
      {"xrGetInstanceProcAddr", plain(&get_proc)},
      {"xrEnumerateInstanceExtensionProperties", plain(&enumerate_extensions)},
      {"xrCreateInstance", plain(&create_instance)},
      {"xrDestroyInstance", plain(&destroy_instance)},
      {"xrStructureTypeToString", plain(&type_text)},
      {"xrResultToString", plain(&result_text)},
      {"xrGetInstanceProperties", plain(&instance_properties)},
      {"xrPollEvent", plain(&poll_event)},
      {"xrGetSystem", plain(&get_system)},
      {"xrGetSystemProperties", plain(&system_properties)},
      {"xrEnumerateViewConfigurationViews", plain(&view_sizes)},
      {"xrEnumerateEnvironmentBlendModes", plain(&blend_modes)},
      {"xrGetOpenGLGraphicsRequirementsKHR", plain(&gl_requirements)},
      {"xrCreateSession", plain(&create_session)},
      {"xrDestroySession", plain(&destroy_session)},
      {"xrBeginSession", plain(&begin_session)},
      {"xrEndSession", plain(&end_session)},
      {"xrCreateReferenceSpace", plain(&create_reference_space)},
      {"xrDestroySpace", plain(&destroy_space)},
      {"xrLocateSpace", plain(&locate_space)},
      {"xrWaitFrame", plain(&wait_frame)},
      {"xrBeginFrame", plain(&begin_frame)},
      {"xrLocateViews", plain(&locate_views)},
      {"xrConvertTimeToTimespecTimeKHR", plain(&convert_time)}};
  const auto found = functions.find(name);
  *out = found != functions.end() ? found->second : frame_function(name);
  if (*out == nullptr) *out = input_function(name);
  if (*out == nullptr) *out = vulkan_function(name);
  return *out != nullptr ? XR_SUCCESS : XR_ERROR_FUNCTION_UNSUPPORTED;
}
}  // namespace

PFN_xrGetInstanceProcAddr runtime_door() { return &get_proc; }

}  // namespace dubsar::testing

extern "C" dubsar::testing::MadeHeadset* made_headset() { return &dubsar::testing::state().headset; }
