#include "display/headset/openxr_instance.h"

#include <openxr/openxr_reflection.h>

#include <algorithm>
#include <cstring>

namespace dubsar::openxr {
namespace {

constexpr std::uint32_t kEyes = 2;

std::vector<XrExtensionProperties> known_extensions() {
  std::uint32_t count = 0;
  if (XR_FAILED(xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr))) return {};
  std::vector<XrExtensionProperties> out(count, made<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
  if (XR_FAILED(xrEnumerateInstanceExtensionProperties(nullptr, count, &count, out.data()))) return {};
  return out;
}

template <std::size_t N>
void copy_text(char (&to)[N], std::string_view text) {
  const std::size_t length = std::min(text.size(), N - 1);
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
}

}  // namespace

std::string name_of(XrResult result) {
  switch (result) {
#define DUBSAR_NAME(name, value) \
  case name:                     \
    return #name;
    XR_LIST_ENUM_XrResult(DUBSAR_NAME)
#undef DUBSAR_NAME
        default : return fmt::format("XrResult {}", static_cast<int>(result));
  }
}

Result<void> check(XrResult result, const char* tried) {
  if (XR_SUCCEEDED(result)) return {};
  return fail(ErrorKind::kUnavailable, "openxr: {} ended with {}", tried, name_of(result));
}

Result<std::unique_ptr<Instance>> Instance::open(bool with_headset) {
  const auto known = known_extensions();
  const auto has = [&](const char* name) {
    return std::any_of(known.begin(), known.end(),
                       [&](const XrExtensionProperties& each) { return std::strcmp(each.extensionName, name) == 0; });
  };
  std::unique_ptr<Instance> out(new Instance);
  std::vector<const char*> wanted;
  const auto want = [&](const char* name) {
    if (has(name)) wanted.push_back(name);
    return has(name);
  };
  const bool gl = want(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  out->egl_ = want(XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
  out->hands_ = want(XR_EXT_HAND_TRACKING_EXTENSION_NAME);
  out->time_ = want(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  auto info = made<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  copy_text(info.applicationInfo.applicationName, "dubsar");
  info.applicationInfo.apiVersion = XR_CURRENT_API_VERSION;
  info.enabledExtensionCount = static_cast<std::uint32_t>(wanted.size());
  info.enabledExtensionNames = wanted.data();
  const XrResult result = xrCreateInstance(&info, &out->instance_);
  if (result == XR_ERROR_RUNTIME_UNAVAILABLE || known.empty())
    return fail(ErrorKind::kUnavailable,
                "openxr: no runtime answers; install one such as Monado or SteamVR and make it the active one "
                "(active_runtime.json, or XR_RUNTIME_JSON), and switch the headset on");
  DUBSAR_TRY(check(result, "reaching the runtime"));
  auto properties = made<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
  if (XR_SUCCEEDED(xrGetInstanceProperties(out->instance_, &properties)))
    out->runtime_ =
        fmt::format("{} {}.{}.{}", properties.runtimeName, XR_VERSION_MAJOR(properties.runtimeVersion),
                    XR_VERSION_MINOR(properties.runtimeVersion), XR_VERSION_PATCH(properties.runtimeVersion));
  if (!gl)
    return fail(ErrorKind::kUnavailable, "openxr: runtime {} does not take OpenGL (XR_KHR_opengl_enable)",
                out->runtime_);
  if (with_headset) DUBSAR_TRY(out->find_headset());
  return out;
}

Result<void> Instance::find_headset() {
  auto wish = made<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
  wish.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  const XrResult found = xrGetSystem(instance_, &wish, &system_);
  if (found == XR_ERROR_FORM_FACTOR_UNAVAILABLE || found == XR_ERROR_FORM_FACTOR_UNSUPPORTED)
    return fail(ErrorKind::kUnavailable, "openxr: runtime {} has no headset now; connect it and switch it on",
                runtime_);
  DUBSAR_TRY(check(found, "looking for a headset"));
  auto hands = made<XrSystemHandTrackingPropertiesEXT>(XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT);
  auto properties = made<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
  if (hands_) properties.next = &hands;
  DUBSAR_TRY(check(xrGetSystemProperties(instance_, system_, &properties), "asking for the headset's name"));
  device_ = properties.systemName;
  hands_ = hands_ && hands.supportsHandTracking == XR_TRUE;
  std::uint32_t count = 0;
  constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  DUBSAR_TRY(check(xrEnumerateViewConfigurationViews(instance_, system_, kStereo, 0, &count, nullptr),
                   "asking for the headset's views"));
  eyes_.assign(count, made<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
  DUBSAR_TRY(check(xrEnumerateViewConfigurationViews(instance_, system_, kStereo, count, &count, eyes_.data()),
                   "asking for the headset's views"));
  if (count != kEyes) return fail(ErrorKind::kUnavailable, "openxr: {} has {} views, expected 2", device_, count);
  XrEnvironmentBlendMode modes[8];
  DUBSAR_TRY(check(xrEnumerateEnvironmentBlendModes(instance_, system_, kStereo, 8, &count, modes),
                   "asking how pictures are blended"));
  blend_ = count > 0 ? modes[0] : XR_ENVIRONMENT_BLEND_MODE_OPAQUE;  // the runtime's favourite is first
  return {};
}

Instance::~Instance() {
  if (instance_ != XR_NULL_HANDLE) xrDestroyInstance(instance_);
}

Result<bool> Instance::next_event(XrEventDataBuffer& event) {
  event = made<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
  const XrResult result = xrPollEvent(instance_, &event);
  if (result == XR_EVENT_UNAVAILABLE) return false;
  DUBSAR_TRY(check(result, "asking for events"));
  return true;
}

}  // namespace dubsar::openxr
