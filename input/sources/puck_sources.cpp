#include "input/sources/puck_sources.h"

#include <fmt/format.h>

#include "devices/driver.h"
#include "devices/spacemouse/spacenav_protocol.h"
#include "input/sources/device_feed.h"
#include "input/sources/threaded_source.h"

namespace dubsar {
namespace {

constexpr int kMostButtons = 64;
constexpr TimestampNs kServerRetryNs = 900'000'000;

template <class Protocol>
class PuckReader final : public SourceReader {
 public:
  PuckReader(DeviceFeed device, const Clock& clock)
      : driver_(std::move(device.open), Protocol(), &clock), ended_(std::move(device.ended)) {}

  bool read(TimestampNs now, milliseconds timeout, InputFrame& frame) override {
    const auto sample = driver_.poll(now, timeout);
    if (!driver_.connected()) release_buttons(now, frame);
    if (!sample) return !frame.events.empty();
    frame.time = sample->time;
    frame.puck = PuckMotion{sample->time, sample->translation, sample->rotation};
    change_buttons(sample->time, sample->buttons, frame);
    return true;
  }
  bool connected() const override { return driver_.connected(); }
  std::string reason() const override { return driver_.reason(); }
  void wake() override { driver_.wake(); }
  bool finished() const override { return ended_ && *ended_; }

 private:
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
  /// An unplugged puck is at rest and holds no button.
  void release_buttons(TimestampNs now, InputFrame& frame) {
    frame.puck.reset();
    if (buttons_ == 0) return;
    frame.time = now;
    change_buttons(now, 0, frame);
  }

  Driver<Protocol> driver_;
  std::shared_ptr<const std::atomic<bool>> ended_;
  std::uint64_t buttons_ = 0;
};

template <class Protocol>
Result<std::unique_ptr<InputSource>> make(const DeviceSpec& choice, OptionReader& options, const InputConfig& config,
                                          TimestampNs retry_ns) {
  DUBSAR_ASSIGN(DeviceFeed device, source_device(choice, options, config));
  DUBSAR_TRY(options.finish());
  DeviceSourceTraits traits;
  traits.name = choice.driver;
  traits.has_end = device.ended != nullptr;
  traits.before_poll = device.before_poll;
  traits.retry_ns = retry_ns;
  return make_device_source(std::move(traits),
                            std::make_unique<PuckReader<Protocol>>(std::move(device), session_clock(config)), config);
}

}  // namespace

Result<std::unique_ptr<InputSource>> make_spacemouse_source(const InputConfig& config) {
  OptionReader options(config, "spacemouse");
  DeviceSpec choice;
  choice.driver = "spacemouse";
  return make<SpaceMouseProtocol>(choice, options, config, 0);
}

Result<std::unique_ptr<InputSource>> make_spacenav_source(const InputConfig& config) {
  OptionReader options(config, "spacenav");
  DeviceSpec choice;
  choice.driver = "spacenav";
  choice.socket = options.text("socket");
  return make<SpacenavProtocol>(choice, options, config, kServerRetryNs);
}

}  // namespace dubsar
