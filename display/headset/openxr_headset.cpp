// Sessions that come and go behind one headset.

#include "core/base/system/log.h"
#include "display/headset/openxr_session.h"
#include "display/render/context/gl_objects.h"

namespace dubsar {
namespace openxr {
namespace {

constexpr TimestampNs kRetryNs = 1'000'000'000;
constexpr TimestampNs kAfterExitNs = 10'000'000'000;  // whoever chose to end does not want to be taken again at once

class OpenXrHeadset final : public Headset {
 public:
  explicit OpenXrHeadset(const HeadsetWish& wish) : wish_(wish) {}

  PixelSize eye_size() const override { return size_; }
  std::string reason() const override { return reason_; }
  bool ended() const override { return ended_; }

  std::optional<WearerFrame> begin() override {
    if (!session_) {
      if (open_again()) reason_ = fmt::format("openxr: {} gets ready", device_);
      return std::nullopt;  // pictures of its size are made from the next turn on
    }
    if (const auto followed = session_->follow_events(); !followed) return lost(followed.error());
    if (!session_->running()) {
      reason_ = fmt::format("openxr: {} is not worn or not ready yet", device_);
      return std::nullopt;
    }
    auto frame = session_->begin();
    if (!frame) return lost(frame.error());
    reason_ = *frame ? "" : fmt::format("openxr: {} does not know where it is", device_);
    return *std::move(frame);
  }

  Result<void> end(const ViewArray& views) override {
    DUBSAR_TRY(check_gl("drawing for a headset"));
    if (!session_ || !session_->begun()) return {};
    if (const auto shown = session_->end(&views); !shown) lost(shown.error());
    const GLenum own = door_.take_own_error();
    if (own == GL_NO_ERROR) return {};
    return fail(ErrorKind::kInternal, "gl: error 0x{:04x} while copying pictures for a headset", own);
  }

 private:
  bool open_again() {
    const TimestampNs now = SteadyClock().now();
    if (now < retry_at_) return false;
    retry_at_ = now + kRetryNs;
    ended_ = false;
    door_.bind_context();
    if (!instance_) {
      auto instance = Instance::open(door_, wish_.see_through);
      if (!instance) return tell(instance.error().message), false;
      instance_ = *std::move(instance);
      device_ = instance_->device();
      const XrViewConfigurationView& eye = instance_->eyes()[0];
      size_ = {static_cast<int>(eye.recommendedImageRectWidth), static_cast<int>(eye.recommendedImageRectHeight)};
    }
    auto session = Session::create(*instance_, wish_.graphics);
    if (!session) {
      tell(session.error().message);
      instance_.reset();  // the runtime may have gone with its headset
      return false;
    }
    session_ = *std::move(session);
    return true;
  }
  std::nullopt_t lost(const Error& error) {
    ended_ = session_->exited();
    tell(error.message);
    session_.reset();
    if (ended_) instance_.reset();
    retry_at_ = ended_ ? SteadyClock().now() + kAfterExitNs : 0;
    return std::nullopt;
  }
  /// Once, until there is something else to tell.
  void tell(const std::string& reason) {
    if (reason != told_) log_warning("{}", reason);
    told_ = reason_ = reason;
  }

  const HeadsetWish wish_;
  Door door_;
  std::unique_ptr<Instance> instance_;
  std::unique_ptr<Session> session_;  // goes first
  std::string device_, reason_, told_;
  PixelSize size_{};
  bool ended_ = false;
  TimestampNs retry_at_ = 0;
};

}  // namespace
}  // namespace openxr

Result<std::unique_ptr<Headset>> make_headset(const HeadsetWish& wish) {
  return std::make_unique<openxr::OpenXrHeadset>(wish);
}

HeadsetFacts headset_facts() {
  openxr::Door door;
  const auto instance = openxr::Instance::open(door, SeeThrough::kNo);
  if (!instance) return {false, instance.error().message};
  return {true, fmt::format("runtime {}, headset {}{}{}{}", (*instance)->runtime(), (*instance)->device(),
                            (*instance)->has_hands() ? ", hands" : ", no hands",
                            !(*instance)->has_gl()   ? ", no OpenGL"
                            : (*instance)->has_egl() ? ", EGL and GLX"
                                                     : ", GLX only",
                            (*instance)->has_vulkan() ? ", Vulkan" : "")};
}

}  // namespace dubsar
