#pragma once
// One OpenXR session: spaces, the pictures of both eyes, frames. It ends when anything is lost; another is made then.

#include <array>
#include <vector>

#include "display/headset/openxr_hands.h"

namespace dubsar::openxr {

class Session {
 public:
  /// Binds the GL context that is current: one of EGL (XR_MNDX_egl_enable) or of GLX. kUnavailable with the reason.
  static Result<std::unique_ptr<Session>> create(Instance& instance);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Follows the runtime's events. kUnavailable, with what happened, when the session is over.
  Result<void> follow_events();
  bool running() const noexcept { return running_; }

  /// kUnavailable when the session is lost; nothing when the runtime skips a frame.
  Result<std::optional<WearerFrame>> begin();
  Result<void> end(const ViewArray* views);
  bool begun() const noexcept { return begun_; }

 private:
  struct Chain {
    XrSwapchain handle = XR_NULL_HANDLE;
    std::vector<XrSwapchainImageOpenGLKHR> images;
    int width = 0, height = 0;
  };
  explicit Session(Instance& instance) : instance_(&instance) {}
  Result<void> make_spaces();
  Result<void> make_chains();
  Result<void> start_running();
  Result<void> copy_eye(const ViewArray& views, std::size_t eye);
  TimestampNs steady_from(XrTime time) const;
  std::optional<double> floor_at(XrTime time) const;

  Instance* instance_;
  XrSession session_ = XR_NULL_HANDLE;
  XrSpace local_ = XR_NULL_HANDLE, stage_ = XR_NULL_HANDLE;
  std::array<Chain, 2> chains_;
  std::unique_ptr<HandInput> hands_;
  std::array<XrView, 2> views_{};
  XrFrameState frame_{};
  bool running_ = false, begun_ = false, recentred_ = false;
};

}  // namespace dubsar::openxr
