#pragma once
// One OpenXR session: spaces, the pictures of both eyes, frames. It ends when anything is lost; another is made then.

#include <array>
#include <vector>

#include "display/headset/openxr_graphics.h"
#include "display/headset/openxr_hands.h"

namespace dubsar::openxr {

class Session {
 public:
  /// With the GL context that is current, or with Vulkan where the runtime takes no OpenGL. kUnavailable with the
  /// reason.
  static Result<std::unique_ptr<Session>> create(Instance& instance, SessionGraphics wish);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Follows the runtime's events. kUnavailable, with what happened, when the session is over.
  Result<void> follow_events();
  bool running() const noexcept { return running_; }
  bool exited() const noexcept { return exited_; }  ///< the wearer chose to end it

  /// kUnavailable when the session is lost; nothing when the runtime skips a frame.
  Result<std::optional<WearerFrame>> begin();
  Result<void> end(const ViewArray* views);
  bool begun() const noexcept { return begun_; }

 private:
  struct Chain {
    XrSwapchain handle = XR_NULL_HANDLE;
    int width = 0, height = 0;
    std::optional<std::uint32_t> acquired;  // an image that the compositor has not let go yet
  };
  explicit Session(Instance& instance) : instance_(&instance) {}
  static Result<std::unique_ptr<Session>> begin_with(Instance& instance, std::unique_ptr<Graphics> graphics);
  Result<void> make_spaces();
  Result<void> make_chains();
  Result<void> start_running();
  /// False when the compositor still shows the image: it is waited for again at the next frame.
  Result<bool> copy_eye(const ViewArray& views, std::size_t eye);
  Result<bool> copy_eyes(const ViewArray& views);
  Door& door() const noexcept { return instance_->door(); }
  bool focused() const noexcept { return state_ == XR_SESSION_STATE_FOCUSED; }
  TimestampNs steady_from(XrTime time) const;
  std::optional<double> floor_at(XrTime time) const;

  Instance* instance_;
  std::unique_ptr<Graphics> graphics_;  // outlives the session
  XrSession session_ = XR_NULL_HANDLE;
  XrSpace local_ = XR_NULL_HANDLE, stage_ = XR_NULL_HANDLE;
  std::array<Chain, 2> chains_;
  std::unique_ptr<HandInput> hands_;
  std::vector<XrView> views_;  // the first two are the eyes
  XrFrameState frame_{};
  XrSessionState state_ = XR_SESSION_STATE_UNKNOWN;
  std::optional<XrTime> recentred_at_;  // when LOCAL is a new one
  bool running_ = false, begun_ = false, exited_ = false;
};

}  // namespace dubsar::openxr
