#include "input/sources/leap_source.h"

#include <chrono>
#include <thread>

#include "devices/leap/leap_camera.h"
#include "devices/transport/retry_pause.h"
#include "input/placement.h"
#include "input/sources/device_feed.h"
#include "input/sources/threaded_source.h"
#include "input/tracking/hands/hand_tracker.h"

namespace dubsar {
namespace {

constexpr TimestampNs kSilentNs = 1'000'000'000;

class LeapReader final : public SourceReader {
 public:
  LeapReader(DeviceFeed device, const LeapCameraOptions& options, const Clock& clock, const Pose& screen_from_leap)
      : driver_(make_leap_camera(std::move(device.open), options, clock)),
        ended_(std::move(device.ended)),
        screen_from_leap_(screen_from_leap) {}

  bool read(TimestampNs now, milliseconds timeout, InputFrame& frame) override {
    if (!open_ && !open(now)) return false;
    const auto until = std::chrono::steady_clock::now() + timeout;
    while (!driver_->poll(picture_)) {
      if (driver_->state() == FrameSourceState::kLost) {
        reason_ = driver_->reason();
        driver_->stop();
        open_ = false;
        retry_.lost(now);
        return false;
      }
      if (std::chrono::steady_clock::now() >= until) return false;
      std::this_thread::sleep_for(milliseconds(1));
    }
    if (!tracker_->track(picture_, hands_)) return false;
    frame.time = picture_.time;
    frame.hands.clear();
    for (const HandFrame& hand : hands_) frame.hands.push_back(moved(screen_from_leap_, hand));
    return true;
  }
  bool connected() const override { return open_; }
  std::string reason() const override { return reason_; }
  void wake() override { retry_.wake(); }
  bool finished() const override { return ended_ && *ended_; }

 private:
  bool open(TimestampNs now) {
    if (!retry_.due(now)) return false;
    if (auto started = driver_->start(); !started) {
      reason_ = std::move(started).error().message;
      retry_.failed(now);
      return false;
    }
    retry_.succeeded();
    reason_.clear();
    if (tracker_ && calibration_ == driver_->calibration()) {
      tracker_->reset();  // the same device: its lenses are known, which took a tenth of a second
    } else {
      calibration_ = driver_->calibration();
      tracker_.emplace(stereo_lenses(*calibration_, driver_->width(), driver_->height()));
    }
    open_ = true;
    return true;
  }

  std::unique_ptr<StereoCamera> driver_;
  std::shared_ptr<const std::atomic<bool>> ended_;
  Pose screen_from_leap_;
  RetryPause retry_;
  std::string reason_;
  bool open_ = false;
  decltype(driver_->calibration()) calibration_;
  std::optional<HandTracker> tracker_;  ///< for `calibration_`
  Frame picture_;
  Hands hands_;
};

}  // namespace

Result<std::unique_ptr<InputSource>> make_leap_source(const InputConfig& config) {
  OptionReader options(config, "leap");
  DeviceSpec choice;
  choice.driver = "leap";
  const Pose place = options.placement(table_placement());
  LeapCameraOptions driver;
  driver.exposure_us = options.integer("exposure_us", 10, 1000, driver.exposure_us);
  driver.own_thread = !config.simulated_time;
  DUBSAR_ASSIGN(DeviceFeed device, source_device(choice, options, config, place));
  DUBSAR_TRY(options.finish());
  if (!device.real) driver.calibration_settle = milliseconds(0);
  DeviceSourceTraits traits;
  traits.name = "leap";
  traits.has_end = device.ended != nullptr;
  traits.before_poll = device.before_poll;
  traits.silent_ns = kSilentNs;
  return make_device_source(
      std::move(traits), std::make_unique<LeapReader>(std::move(device), driver, session_clock(config), place), config);
}

}  // namespace dubsar
