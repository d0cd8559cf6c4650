#include "display/headset/openxr_instance.h"

#include <openxr/openxr_reflection.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/base/system/log.h"

namespace dubsar::openxr {
namespace {

constexpr std::uint32_t kEyes = 2;
constexpr XrVersion kApi = XR_MAKE_VERSION(1, 0, 0);  // newer headers ask for 1.1, which runtimes of 1.0 refuse

std::vector<XrExtensionProperties> known_extensions(Door& door) {
  std::uint32_t count = 0;
  if (XR_FAILED(door(xrEnumerateInstanceExtensionProperties, nullptr, 0u, &count, nullptr))) return {};
  std::vector<XrExtensionProperties> out(count, made<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
  if (XR_FAILED(door(xrEnumerateInstanceExtensionProperties, nullptr, count, &count, out.data()))) return {};
  return out;
}

/// The file that names the active runtime, in the loader's order (OpenXR loader specification); empty: none.
std::filesystem::path runtime_file() {
  if (const char* const said = std::getenv("XR_RUNTIME_JSON"); said != nullptr && *said != '\0') return said;
  std::vector<std::filesystem::path> folders;
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  if (config != nullptr && *config != '\0')
    folders.emplace_back(config);
  else if (home != nullptr)
    folders.push_back(std::filesystem::path(home) / ".config");
  for (const char* const folder : {"/etc/xdg", "/usr/local/etc", "/etc", "/usr/local/share", "/usr/share"})
    folders.emplace_back(folder);
  std::error_code ignored;
  for (const std::filesystem::path& folder : folders)
    if (const auto file = folder / "openxr/1/active_runtime.json"; std::filesystem::exists(file, ignored)) return file;
  return {};
}

Error no_runtime(XrResult result) {
  const std::filesystem::path file = runtime_file();
  std::error_code ignored;
  if (file.empty())
    return {ErrorKind::kUnavailable,
            "openxr: no runtime is installed; install one such as Monado or SteamVR and make it the active one "
            "(active_runtime.json, or XR_RUNTIME_JSON)"};
  if (!std::filesystem::exists(file, ignored))
    return {ErrorKind::kUnavailable,
            fmt::format("openxr: no runtime answers: {} (XR_RUNTIME_JSON) is not there", file.string())};
  return {ErrorKind::kUnavailable,
          fmt::format("openxr: no runtime answers ({}); start the one of {} (Monado: monado-service; SteamVR: Steam's "
                      "VR button) and switch the headset on",
                      name_of(result), file.string())};
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

Result<std::unique_ptr<Instance>> Instance::open(Door& door, SeeThrough wish) {
  const auto known = known_extensions(door);
  const auto has = [&](const char* name) {
    return std::any_of(known.begin(), known.end(),
                       [&](const XrExtensionProperties& each) { return std::strcmp(each.extensionName, name) == 0; });
  };
  std::unique_ptr<Instance> out(new Instance(door));
  std::vector<const char*> wanted;
  const auto want = [&](const char* name) {
    if (has(name)) wanted.push_back(name);
    return has(name);
  };
  out->gl_ = want(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  out->vulkan_ = want(XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME);
  out->egl_ = want(XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
  out->hands_ = want(XR_EXT_HAND_TRACKING_EXTENSION_NAME);
  out->hand_source_ = out->hands_ && want(XR_EXT_HAND_TRACKING_DATA_SOURCE_EXTENSION_NAME);
  out->time_ = want(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  auto info = made<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  copy_text(info.applicationInfo.applicationName, "dubsar");
  info.applicationInfo.apiVersion = kApi;
  info.enabledExtensionCount = static_cast<std::uint32_t>(wanted.size());
  info.enabledExtensionNames = wanted.data();
  const XrResult result = door(xrCreateInstance, &info, &out->instance_);
  if (XR_FAILED(result)) out->instance_ = XR_NULL_HANDLE;
  if (XR_FAILED(result) || known.empty()) return tl::unexpected<Error>(no_runtime(result));
  auto properties = made<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
  if (XR_SUCCEEDED(door(xrGetInstanceProperties, out->instance_, &properties)))
    out->runtime_ =
        fmt::format("{} {}.{}.{}", properties.runtimeName, XR_VERSION_MAJOR(properties.runtimeVersion),
                    XR_VERSION_MINOR(properties.runtimeVersion), XR_VERSION_PATCH(properties.runtimeVersion));
  if (!out->gl_ && !out->vulkan_)
    return fail(ErrorKind::kUnavailable,
                "openxr: runtime {} takes neither OpenGL (XR_KHR_opengl_enable) nor Vulkan (XR_KHR_vulkan_enable2)",
                out->runtime_);
  DUBSAR_TRY(out->find_headset(wish));
  return out;
}

Result<void> Instance::find_headset(SeeThrough wish) {
  auto form = made<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
  form.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  const XrResult found = door()(xrGetSystem, instance_, &form, &system_);
  if (found == XR_ERROR_FORM_FACTOR_UNAVAILABLE || found == XR_ERROR_FORM_FACTOR_UNSUPPORTED)
    return fail(ErrorKind::kUnavailable, "openxr: runtime {} has no headset now; connect it and switch it on",
                runtime_);
  DUBSAR_TRY(check(found, "looking for a headset"));
  auto hands = made<XrSystemHandTrackingPropertiesEXT>(XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT);
  auto properties = made<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
  if (hands_) properties.next = &hands;
  DUBSAR_TRY(check(door()(xrGetSystemProperties, instance_, system_, &properties), "asking for the headset's name"));
  device_ = properties.systemName;
  hands_ = hands_ && hands.supportsHandTracking == XR_TRUE;
  std::uint32_t count = 0;
  DUBSAR_TRY(check(door()(xrEnumerateViewConfigurationViews, instance_, system_, kStereo, 0u, &count, nullptr),
                   "asking for the headset's views"));
  eyes_.assign(count, made<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
  DUBSAR_TRY(check(door()(xrEnumerateViewConfigurationViews, instance_, system_, kStereo, count, &count, eyes_.data()),
                   "asking for the headset's views"));
  if (count < kEyes || eyes_[0].recommendedImageRectWidth < 1 || eyes_[0].recommendedImageRectHeight < 1)
    return fail(ErrorKind::kUnavailable, "openxr: {} has {} views of {}x{} pixels, expected two eyes", device_, count,
                count < 1 ? 0 : eyes_[0].recommendedImageRectWidth,
                count < 1 ? 0 : eyes_[0].recommendedImageRectHeight);
  view_count_ = count;
  eyes_.resize(kEyes);  // panels of several modes count the views of the largest; the first two are a pair
  return find_blend(wish);
}

/// The one that was asked for where there is it; else what pictures that fill the view need; else the runtime's first.
Result<void> Instance::find_blend(SeeThrough wish) {
  std::uint32_t count = 0;
  DUBSAR_TRY(check(door()(xrEnumerateEnvironmentBlendModes, instance_, system_, kStereo, 0u, &count, nullptr),
                   "asking how pictures are blended"));
  std::vector<XrEnvironmentBlendMode> modes(count);
  DUBSAR_TRY(check(door()(xrEnumerateEnvironmentBlendModes, instance_, system_, kStereo, count, &count, modes.data()),
                   "asking how pictures are blended"));
  const XrEnvironmentBlendMode wanted = wish == SeeThrough::kAlpha      ? XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND
                                        : wish == SeeThrough::kAdditive ? XR_ENVIRONMENT_BLEND_MODE_ADDITIVE
                                                                        : XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  const bool there = std::find(modes.begin(), modes.end(), wanted) != modes.end();
  blend_ = there || modes.empty() ? wanted : modes.front();
  if (!there && wish != SeeThrough::kNo)
    log_warning("openxr: {} blends no pictures as blend= asks; they are shown as it does by itself", device_);
  return {};
}

Instance::~Instance() {
  if (instance_ != XR_NULL_HANDLE) door()(xrDestroyInstance, instance_);
}

Result<bool> Instance::next_event(XrEventDataBuffer& event) {
  event = made<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
  const XrResult result = door()(xrPollEvent, instance_, &event);
  if (result == XR_EVENT_UNAVAILABLE) return false;
  DUBSAR_TRY(check(result, "asking for events"));
  return true;
}

}  // namespace dubsar::openxr
