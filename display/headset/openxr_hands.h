#pragma once
// The wearer's hands, by XR_EXT_hand_tracking, and controllers, by actions.

#include <array>

#include "display/headset/headset.h"
#include "display/headset/openxr_instance.h"

namespace dubsar::openxr {

class HandInput {
 public:
  /// For a session that has not begun. Runtimes without hands or without one of the controllers are fine.
  static Result<std::unique_ptr<HandInput>> create(const Instance& instance, XrSession session);
  ~HandInput();
  HandInput(const HandInput&) = delete;
  HandInput& operator=(const HandInput&) = delete;

  /// Fills hands and controllers as they will be at `time`, in `base`. For a session that has the input focus.
  void locate(XrSpace base, XrTime time, WearerFrame& frame);

 private:
  explicit HandInput(const Instance& instance) : instance_(&instance) {}
  Result<void> make_actions(XrSession session);
  Result<XrAction> make_action(const char* name, const char* words, XrActionType type);
  void suggest(const char* profile, const char* squeeze, const char* select);
  void locate_controllers(XrSpace base, XrTime time, WearerFrame& frame);
  Result<void> make_trackers(XrSession session);
  Door& door() const noexcept { return instance_->door(); }

  const Instance* instance_;
  XrSession session_ = XR_NULL_HANDLE;
  std::array<XrHandTrackerEXT, 2> trackers_{};
  std::array<XrPath, 2> sides_{};
  std::array<XrSpace, 2> grips_{};
  XrActionSet set_ = XR_NULL_HANDLE;
  XrAction grip_ = XR_NULL_HANDLE, squeeze_ = XR_NULL_HANDLE, select_ = XR_NULL_HANDLE;
  PFN_xrLocateHandJointsEXT locate_joints_ = nullptr;
};

}  // namespace dubsar::openxr
