#include "input/sources/device_feed.h"

#include "devices/real/real_devices.h"
#include "devices/transport/replay_transport.h"
#include "input/simulated/simulated_device.h"
#include "input/source_options.h"
#include "input/sources/threaded_source.h"

namespace dubsar {
namespace {

struct Replay {
  Replay(Recording recording, const Clock& clock, double speed) : session(std::move(recording), clock, speed) {}
  ReplaySession session;
  std::atomic<bool> ended{false};
};

/// Keeps the session alive and notes its end.
class ReplayedTransport final : public Transport {
 public:
  ReplayedTransport(std::shared_ptr<Replay> replay, std::unique_ptr<Transport> below)
      : replay_(std::move(replay)), below_(std::move(below)) {}
  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    auto length = below_->read(report, timeout);
    if (!length && replay_->session.finished()) replay_->ended = true;
    return length;
  }
  Result<void> write(std::span<const std::byte> report) override { return below_->write(report); }
  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    return below_->get_feature(id, out);
  }
  Result<void> set_feature(std::span<const std::byte> report) override { return below_->set_feature(report); }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    return below_->control(request, data, timeout);
  }
  UsbId usb_id() const noexcept override { return below_->usb_id(); }

 private:
  std::shared_ptr<Replay> replay_;
  std::unique_ptr<Transport> below_;
};

/// The person acts on the session's clock and sees the session's view.
Result<DeviceFeed> simulated_device(std::string_view driver, WireOptions wire, const InputConfig& config) {
  std::function<void()> before_poll;
  if (config.seen_view) {
    auto seen = std::make_shared<SeenView>();
    before_poll = [seen, view = config.seen_view] { seen->show(view()); };
    wire.seen = std::move(seen);
  }
  DUBSAR_ASSIGN(std::shared_ptr<SimulatedDevice> person,
                make_wire_person(driver, std::move(wire), session_clock(config)));
  auto ended = person->ended();
  return DeviceFeed{reach_wire_person(std::move(person), session_clock(config)), std::move(ended),
                    std::move(before_poll), false};
}

}  // namespace

Result<DeviceFeed> replayed_device(std::string_view driver, const std::string& file, double speed, const Clock& clock) {
  DUBSAR_ASSIGN(Recording recording, read_recording(file));
  if (recording.driver != driver)
    return fail(ErrorKind::kBadData, "{}: a recording of \"{}\" found, expected one of \"{}\"", file, recording.driver,
                driver);
  auto replay = std::make_shared<Replay>(std::move(recording), clock, speed);
  return DeviceFeed{[replay]() -> Result<std::unique_ptr<Transport>> {
                      auto opened = replay->session.open();
                      if (!opened) {
                        replay->ended = true;
                        return opened;
                      }
                      return std::make_unique<ReplayedTransport>(replay, std::move(*opened));
                    },
                    std::shared_ptr<const std::atomic<bool>>(replay, &replay->ended),
                    {},
                    false};
}

Result<DeviceFeed> source_device(const DeviceSpec& choice, OptionReader& options, const InputConfig& config,
                                 const Pose& screen_from_device) {
  const Clock& clock = session_clock(config);
  const std::string file = options.text("replay"), script = options.text("simulate");
  const double speed = options.number("speed", 0.01, 1000.0, 1.0), seed = options.number("seed", -1.0, 9e15, -1.0);
  if (!file.empty() && !script.empty())
    return fail(ErrorKind::kUsage, "input {}: replay and simulate found, expected one of them", choice.driver);
  if (!file.empty()) return replayed_device(choice.driver, file, speed, clock);
  if (!script.empty()) {
    WireOptions wire;
    DUBSAR_ASSIGN(const std::string text, read_source_text(script));
    DUBSAR_ASSIGN(wire.script, parse_script(text, script));
    if (seed >= 0) wire.script.seed = static_cast<std::uint64_t>(seed);
    wire.screen_from_device = screen_from_device;
    return simulated_device(choice.driver, std::move(wire), config);
  }
  DUBSAR_ASSIGN(OpenTransport open,
                (config.reach_device ? config.reach_device : DeviceOpener(reach_real_device))(choice, clock));
  return DeviceFeed{std::move(open), nullptr, {}, !config.reach_device};
}

}  // namespace dubsar
