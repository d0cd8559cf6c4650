#pragma once
// The connection to an OpenXR runtime and its headset, before anything is drawn.

#include <memory>
#include <vector>

#include "display/headset/headset.h"
#include "display/headset/openxr_door.h"

namespace dubsar::openxr {

class Instance {
 public:
  /// Through `door`, which outlives it. kUnavailable, with what to do: no runtime, none that takes OpenGL or Vulkan, no
  /// headset.
  static Result<std::unique_ptr<Instance>> open(Door& door, SeeThrough wish);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  Door& door() const noexcept { return *door_; }
  XrInstance handle() const noexcept { return instance_; }
  XrSystemId system() const noexcept { return system_; }
  bool has_gl() const noexcept { return gl_; }
  bool has_vulkan() const noexcept { return vulkan_; }  ///< XR_KHR_vulkan_enable2
  bool has_egl() const noexcept { return egl_; }
  bool has_hands() const noexcept { return hands_; }
  bool tells_hand_source() const noexcept { return hand_source_; }  ///< seen hands from those a controller stands for
  bool has_time() const noexcept { return time_; }                  ///< its times can be compared with CLOCK_MONOTONIC
  const std::string& runtime() const noexcept { return runtime_; }
  const std::string& device() const noexcept { return device_; }
  const std::vector<XrViewConfigurationView>& eyes() const noexcept { return eyes_; }  ///< two
  std::uint32_t view_count() const noexcept { return view_count_; }  ///< 2, or more on panels of several modes
  XrEnvironmentBlendMode blend() const noexcept { return blend_; }

  /// XR_SESSION_STATE_... and other news; false when there is none. kUnavailable when the runtime is gone.
  Result<bool> next_event(XrEventDataBuffer& event);

 private:
  explicit Instance(Door& door) : door_(&door) {}
  Result<void> find_headset(SeeThrough wish);
  Result<void> find_blend(SeeThrough wish);
  Door* door_;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  bool gl_ = false, vulkan_ = false, egl_ = false, hands_ = false, hand_source_ = false, time_ = false;
  std::string runtime_, device_;
  std::vector<XrViewConfigurationView> eyes_;
  std::uint32_t view_count_ = 0;
  XrEnvironmentBlendMode blend_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
};

}  // namespace dubsar::openxr
