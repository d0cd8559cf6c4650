#include "input/sources/leapc_source.h"

#include <optional>
#include <utility>

#include "devices/drivers.h"
#include "input/sources/leapc_hands.h"

namespace dubsar {
namespace {

class LeapcSource final : public InputSource {
 public:
  LeapcSource(std::unique_ptr<leapc::Connection> connection, const Pose& screen_from_device, bool simulated_time)
      : connection_(std::move(connection)), screen_from_device_(screen_from_device), simulated_time_(simulated_time) {}

  std::string_view name() const noexcept override { return "leapc"; }
  Result<void> start() override {
    heard_.reset();
    return connection_->start();
  }
  std::string note() const override {
    return silent_ ? "leapc: the device sends nothing: see Ultraleap's control panel, or plug it in again"
                   : connection_->reason();
  }

  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    newest.events.clear();
    const bool fresh = connection_->poll(frame_);
    if (fresh || !heard_) heard_ = now;
    const bool tracking = connection_->state() == leapc::State::kTracking;
    silent_ = tracking && !simulated_time_ && now - *heard_ > kLeapcSilentNs;
    if (!tracking || silent_) {
      newest.hands.clear();
      return Freshness::kLost;
    }
    if (!fresh) return Freshness::kUnchanged;
    newest.time = simulated_time_ ? now : frame_.time;
    newest.hands.clear();
    for (const leapc::Hand& hand : frame_.hands)
      if (newest.hands.size() < kMaxHands)
        newest.hands.push_back(moved(screen_from_device_, hand_from_leapc(hand, newest.time)));
    return Freshness::kNew;
  }

 private:
  std::unique_ptr<leapc::Connection> connection_;
  const Pose screen_from_device_;
  const bool simulated_time_;
  leapc::ServiceFrame frame_;
  bool silent_ = false;
  std::optional<TimestampNs> heard_;  // when something fresh was polled, or the first poll
};

Result<leapc::Mode> mode_named(std::string_view name) {
  if (name == "desktop") return leapc::Mode::kDesktop;
  if (name == "screentop") return leapc::Mode::kScreenTop;
  if (name == "headmounted") return leapc::Mode::kHeadMounted;
  return fail(ErrorKind::kUsage, "input leapc: mode={} found, expected desktop, screentop or headmounted", name);
}

}  // namespace

std::unique_ptr<InputSource> leapc_source(std::unique_ptr<leapc::Connection> connection, const Pose& screen_from_device,
                                          bool simulated_time) {
  return std::make_unique<LeapcSource>(std::move(connection), screen_from_device, simulated_time);
}

Result<std::unique_ptr<InputSource>> make_leapc_source(const InputConfig& config) {
  static const SteadyClock kSteady;
  DUBSAR_ASSIGN(const DriverEntry* driver, find_driver("leapc", "input", driver_table()));
  OptionReader reader(config.options, "input leapc");
  leapc::Options options;
  options.patience = milliseconds(0);
  options.library = reader.text("library");
  DUBSAR_ASSIGN(options.mode, mode_named(reader.text("mode", "desktop")));
  const Pose screen_from_device = reader.placement(driver->usual_place);
  DUBSAR_TRY(reader.finish());
  return leapc_source(leapc::make_connection(options, config.clock ? *config.clock : kSteady), screen_from_device,
                      config.simulated_time);
}

}  // namespace dubsar
