#pragma once
// The connection to an OpenXR runtime and its headset, before anything is drawn.

#include <memory>
#include <vector>

#include "display/headset/openxr_api.h"

namespace dubsar::openxr {

class Instance {
 public:
  /// kUnavailable: no runtime, none that takes OpenGL, no headset. `with_headset` false: only what the runtime is.
  static Result<std::unique_ptr<Instance>> open(bool with_headset = true);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  XrInstance handle() const noexcept { return instance_; }
  XrSystemId system() const noexcept { return system_; }
  bool has_egl() const noexcept { return egl_; }
  bool has_hands() const noexcept { return hands_; }
  bool has_time() const noexcept { return time_; }  ///< its times can be compared with CLOCK_MONOTONIC
  const std::string& runtime() const noexcept { return runtime_; }
  const std::string& device() const noexcept { return device_; }
  const std::vector<XrViewConfigurationView>& eyes() const noexcept { return eyes_; }
  XrEnvironmentBlendMode blend() const noexcept { return blend_; }

  /// XR_SESSION_STATE_... and other news; false when there is none. kUnavailable when the runtime is gone.
  Result<bool> next_event(XrEventDataBuffer& event);

 private:
  Instance() = default;
  Result<void> find_headset();
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  bool egl_ = false, hands_ = false, time_ = false;
  std::string runtime_, device_;
  std::vector<XrViewConfigurationView> eyes_;
  XrEnvironmentBlendMode blend_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
};

}  // namespace dubsar::openxr
