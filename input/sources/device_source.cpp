#include "input/sources/device_source.h"

#include <fmt/format.h>

#include "devices/frame_source.h"
#include "devices/leap/lmc1_calibration.h"
#include "input/sources/device_feed.h"
#include "input/sources/head_placement.h"
#include "input/sources/threaded_source.h"
#include "input/tracking/hands/hand_tracker.h"

namespace dubsar {
namespace {

constexpr int kMostButtons = 64;
constexpr TimestampNs kDeviceSilentNs = 1'000'000'000, kServerRetryNs = 900'000'000;

class DeviceReader final : public SourceReader {
 public:
  DeviceReader(std::unique_ptr<DeviceDriver> driver, std::shared_ptr<const std::atomic<bool>> ended,
               const HeadPlacement& placement)
      : driver_(std::move(driver)), ended_(std::move(ended)), placement_(placement) {}

  bool read(TimestampNs now, milliseconds timeout, InputFrame& frame) override {
    const auto sample = driver_->next(now, timeout);
    const bool used = sample && std::visit([&](const auto& s) { return use(s, frame); }, *sample);
    if (!driver_->connected()) let_go(now, frame);
    return used || !frame.events.empty() || !frame.touches.empty();
  }
  bool connected() const override { return driver_->connected(); }
  std::string reason() const override { return driver_->reason(); }
  std::string note() const override { return driver_->note(); }
  void wake() override { driver_->wake(); }
  void recentre() override { driver_->recentre(); }
  bool finished() const override { return ended_ && *ended_; }

 private:
  bool use(const SpaceMouseSample& sample, InputFrame& frame) {
    frame.time = sample.time;
    frame.space_mouse = SpaceMouseMotion{sample.time, sample.translation, sample.rotation};
    change_buttons(sample.time, sample.buttons, frame);
    return true;
  }
  bool use(const HeadSample& sample, InputFrame& frame) {
    frame.time = sample.time;
    frame.heads.clear();
    if (const auto head = head_frame(sample, placement_)) frame.heads.push_back(*head);
    return true;
  }
  bool use(const StereoSample& sample, InputFrame& frame) {
    if (!tracker_ || calibration_ != *sample.calibration) {
      calibration_ = *sample.calibration;
      tracker_.emplace(stereo_lenses(*calibration_, sample.picture->width, sample.picture->height));
    } else if (losses_ != driver_->counts().losses) {
      tracker_->reset();  // the same device: its lenses are known, which took a tenth of a second
    }
    losses_ = driver_->counts().losses;
    if (!tracker_->track(*sample.picture, hands_)) return false;
    frame.time = sample.time;
    frame.hands.clear();
    for (const HandFrame& hand : hands_) frame.hands.push_back(moved(placement_.screen_from_tracker, hand));
    return true;
  }

  bool use(const TouchSample& sample, InputFrame& frame) {
    frame.time = sample.time;
    frame.touches = sample.frames;
    touched_ = !sample.frames.back().contacts.empty();
    return true;
  }

  void change_buttons(TimestampNs time, std::uint64_t buttons, InputFrame& frame) {
    for (int i = 0; i < kMostButtons; ++i) {
      const bool down = (buttons >> i & 1U) != 0;
      if (down == ((buttons_ >> i & 1U) != 0)) continue;
      InputEvent event;
      event.time = time;
      event.kind = EventKind::kKey;
      event.down = down;
      event.key = fmt::format("puck{}", i + 1);
      frame.events.push_back(std::move(event));
    }
    buttons_ = buttons;
  }
  /// An unplugged SpaceMouse is at rest and holds no button; no finger is on a panel that is gone.
  void let_go(TimestampNs now, InputFrame& frame) {
    frame.space_mouse.reset();
    if (std::exchange(touched_, false)) {
      frame.time = now;
      frame.touches.push_back({now, {}, true});
    }
    if (buttons_ == 0) return;
    frame.time = now;
    change_buttons(now, 0, frame);
  }

  std::unique_ptr<DeviceDriver> driver_;
  std::shared_ptr<const std::atomic<bool>> ended_;
  HeadPlacement placement_;
  std::uint64_t buttons_ = 0, losses_ = 0;
  std::optional<lmc1::Calibration> calibration_;
  std::optional<HandTracker> tracker_;  ///< for `calibration_`
  Hands hands_;
  bool touched_ = false;  ///< fingers are on the glass
};

}  // namespace

Result<std::unique_ptr<InputSource>> make_device_source(const DriverEntry& driver, const InputConfig& config) {
  if (!can_be_opened(driver)) return fail(ErrorKind::kUsage, "input: {} gives no input", driver.name);
  OptionReader options(config.options,
                       fmt::format("input {}", driver.input.source.substr(0, driver.input.source.find(':'))));
  if (driver.input.source.find(':') != std::string_view::npos) static_cast<void>(options.first_word());  // "opentrack"
  HeadPlacement placement;
  const bool told_at_rest = driver.gives != Gives::kSpaceMouse && driver.gives != Gives::kTouches;
  if (told_at_rest) placement.screen_from_tracker = options.placement(driver.usual_place);
  if (driver.gives == Gives::kHead) {
    placement.eyes_m = 1e-3 * options.triple("eyes", 500.0, glm::dvec3(0.0));
    placement.ipd_m = 1e-3 * options.number("ipd", 40.0, 90.0, 63.0);
  }
  DUBSAR_ASSIGN(DeviceFeed feed, make_device_feed(driver, options, config, placement.screen_from_tracker));
  auto device = driver.drive(std::move(feed.open), options, &session_clock(config));
  DUBSAR_TRY(options.finish());
  ThreadedSourceTraits traits;
  traits.name = driver.input.source;
  if (!driver.input.lacks.empty()) traits.note = fmt::format("{}: {}", driver.input.source, driver.input.lacks);
  traits.has_end = feed.ended != nullptr;
  traits.before_poll = std::move(feed.before_poll);
  if (told_at_rest) traits.silent_ns = kDeviceSilentNs;
  if (driver.bus == Bus::kUdp || driver.bus == Bus::kTcp || driver.bus == Bus::kUnixSocket)
    traits.retry_ns = kServerRetryNs;
  return make_threaded_source(
      std::move(traits), std::make_unique<DeviceReader>(std::move(device), std::move(feed.ended), placement), config);
}

}  // namespace dubsar
