// The door: sessions that come and go behind one headset.

#include "core/base/system/log.h"
#include "display/headset/openxr_session.h"
#include "display/render/context/gl_objects.h"

namespace dubsar {
namespace openxr {
namespace {

constexpr TimestampNs kRetryNs = 1'000'000'000;

class OpenXrHeadset final : public Headset {
 public:
  explicit OpenXrHeadset(std::unique_ptr<Instance> instance)
      : instance_(std::move(instance)),
        runtime_(instance_->runtime()),
        device_(instance_->device()),
        hands_(instance_->has_hands()),
        size_{static_cast<int>(instance_->eyes()[0].recommendedImageRectWidth),
              static_cast<int>(instance_->eyes()[0].recommendedImageRectHeight)} {}

  std::string runtime() const override { return runtime_; }
  std::string device() const override { return device_; }
  PixelSize eye_size() const override { return size_; }
  bool has_hands() const override { return hands_; }
  std::string reason() const override { return reason_; }

  std::optional<WearerFrame> begin() override {
    if (!session_ && !open_again()) return std::nullopt;
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
    if (!session_ || !session_->begun()) return {};
    if (const auto shown = session_->end(&views); !shown) lost(shown.error());
    return check_gl("showing pictures in a headset");
  }

 private:
  bool open_again() {
    const TimestampNs now = SteadyClock().now();
    if (now < retry_at_) return false;
    retry_at_ = now + kRetryNs;
    if (!instance_) {
      auto instance = Instance::open();
      if (!instance) return reason_ = instance.error().message, false;
      instance_ = *std::move(instance);
    }
    auto session = Session::create(*instance_);
    if (!session) {
      reason_ = session.error().message;
      instance_.reset();  // the runtime may have gone with its headset
      return false;
    }
    session_ = *std::move(session);
    return true;
  }
  std::nullopt_t lost(const Error& error) {
    reason_ = error.message;
    log_warning("{}", reason_);
    session_.reset();
    retry_at_ = 0;
    return std::nullopt;
  }

  std::unique_ptr<Instance> instance_;
  std::unique_ptr<Session> session_;  // goes first
  std::string runtime_, device_, reason_;
  bool hands_;
  PixelSize size_;
  TimestampNs retry_at_ = 0;
};

}  // namespace
}  // namespace openxr

Result<std::unique_ptr<Headset>> open_headset() {
  DUBSAR_ASSIGN(auto instance, openxr::Instance::open());
  return std::make_unique<openxr::OpenXrHeadset>(std::move(instance));
}

HeadsetFacts headset_facts() {
  const auto instance = openxr::Instance::open();
  if (!instance) {
    const auto runtime = openxr::Instance::open(false);
    return {false, runtime ? fmt::format("runtime {}: {}", (*runtime)->runtime(), instance.error().message)
                           : instance.error().message};
  }
  return {true, fmt::format("runtime {}, headset {}{}{}", (*instance)->runtime(), (*instance)->device(),
                            (*instance)->has_hands() ? ", hands" : ", no hands",
                            (*instance)->has_egl() ? ", EGL and GLX" : ", GLX only")};
}

}  // namespace dubsar
