#include "input/sources/device_feed.h"

#include "devices/transport/forwarding_transport.h"
#include "devices/transport/replay_transport.h"
#include "input/simulated/simulated_feed.h"
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
class ReplayedTransport final : public ForwardingTransport {
 public:
  ReplayedTransport(std::shared_ptr<Replay> replay, std::unique_ptr<Transport> below)
      : ForwardingTransport(std::move(below)), replay_(std::move(replay)) {}
  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    auto length = below().read(report, timeout);
    if (!length && replay_->session.finished()) replay_->ended = true;
    return length;
  }

 private:
  std::shared_ptr<Replay> replay_;
};

/// The person acts on the session's clock and sees the session's view.
Result<DeviceFeed> simulated_device(const DriverEntry& driver, PersonOptions person, const InputConfig& config) {
  std::function<void()> before_poll;
  if (config.seen_view) {
    auto seen = std::make_shared<SeenView>();
    before_poll = [seen, view = config.seen_view] { seen->show(view()); };
    person.seen = std::move(seen);
  }
  DUBSAR_ASSIGN(SimulatedFeed feed, simulate_device(driver, std::move(person), session_clock(config)));
  return DeviceFeed{open_simulated(std::move(feed.device), session_clock(config)), feed.person->ended(),
                    std::move(before_poll)};
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
                    {}};
}

Result<DeviceFeed> make_device_feed(const DriverEntry& driver, OptionReader& options, const InputConfig& config,
                                    const Pose& screen_from_device) {
  const Clock& clock = session_clock(config);
  DUBSAR_ASSIGN(OpenTransport real, driver.open(driver, options, clock));  // opens nothing yet
  const std::string file = options.text("replay"), script = options.text("simulate");
  const double speed = options.number("speed", 0.01, 1000.0, 1.0), seed = options.number("seed", -1.0, 9e15, -1.0);
  DUBSAR_TRY(options.status());
  if (!file.empty() && !script.empty())
    return fail(ErrorKind::kUsage, "input {}: replay and simulate found, expected one of them", driver.input.source);
  if (!file.empty()) return replayed_device(driver.name, file, speed, clock);
  if (!script.empty()) {
    PersonOptions person;
    DUBSAR_ASSIGN(const std::string text, read_source_text(script));
    DUBSAR_ASSIGN(person.script, parse_script(text, script));
    if (seed >= 0) person.script.seed = static_cast<std::uint64_t>(seed);
    person.screen_from_device = screen_from_device;
    return simulated_device(driver, std::move(person), config);
  }
  if (!config.reach_device) return DeviceFeed{std::move(real)};
  DUBSAR_ASSIGN(OpenTransport reached,
                config.reach_device(DeviceSpec{std::string(driver.name), config.options}, clock));
  return DeviceFeed{std::move(reached)};
}

}  // namespace dubsar
