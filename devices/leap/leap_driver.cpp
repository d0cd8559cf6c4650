#include "devices/leap/leap_driver.h"

#include "devices/transport/retry_pause.h"

namespace dubsar {
namespace {

class LeapDriver final : public DeviceDriver {
 public:
  LeapDriver(OpenTransport open, const LeapCameraOptions& options, const Clock& clock)
      : camera_(make_leap_camera(std::move(open), options, clock)) {}

  std::optional<DeviceSample> next(TimestampNs now, milliseconds timeout) override {
    if (!open_ && !open(now)) return std::nullopt;
    const bool any = camera_->wait(picture_, timeout);
    counts_.accepted = before_.accepted + camera_->counters().frames;
    counts_.refused = before_.refused + camera_->counters().dropped_frames;
    if (any) return StereoSample{picture_.time, &picture_, &*calibration_};
    if (camera_->state() == FrameSourceState::kLost) lose(now);
    return std::nullopt;
  }
  bool connected() const noexcept override { return open_; }
  const std::string& reason() const noexcept override { return reason_; }
  std::string note() const override { return {}; }
  const DriverCounts& counts() const noexcept override { return counts_; }
  void wake() noexcept override { retry_.wake(); }
  void recentre() noexcept override {}

 private:
  bool open(TimestampNs now) {
    if (!retry_.due(now)) return false;
    before_ = counts_;
    if (auto started = camera_->start(); !started) {
      reason_ = std::move(started).error().message;
      retry_.failed(now);
      return false;
    }
    retry_.succeeded();
    reason_.clear();
    calibration_ = camera_->calibration();
    return open_ = true;
  }
  void lose(TimestampNs now) {
    reason_ = camera_->reason();
    camera_->stop();
    open_ = false;
    ++counts_.losses;
    retry_.lost(now);
  }

  std::unique_ptr<StereoCamera> camera_;
  RetryPause retry_;
  std::string reason_;
  std::optional<lmc1::Calibration> calibration_;
  Frame picture_;
  DriverCounts counts_, before_;  // before_: when it was opened last
  bool open_ = false;
};

}  // namespace

std::unique_ptr<DeviceDriver> make_leap_driver(OpenTransport open, const LeapCameraOptions& options,
                                               const Clock& clock) {
  return std::make_unique<LeapDriver>(std::move(open), options, clock);
}

std::unique_ptr<DeviceDriver> drive_leap(OpenTransport open, OptionReader& options, const Clock* stamps) {
  static const SteadyClock kSteady;
  LeapCameraOptions camera;
  camera.exposure_us = options.integer("exposure_us", 10, 1000, camera.exposure_us);
  return make_leap_driver(std::move(open), camera, stamps != nullptr ? *stamps : kSteady);
}

}  // namespace dubsar
