#include "input/simulated/simulated_device.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "input/simulated/scripted_wire.h"

namespace dubsar {
namespace {

class PersonTransport final : public Transport {
 public:
  PersonTransport(std::shared_ptr<SimulatedDevice> person, std::unique_ptr<Transport> below, const Clock& clock)
      : person_(std::move(person)), below_(std::move(below)), clock_(clock) {}

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    const auto until = std::chrono::steady_clock::now() + timeout;
    for (;;) {
      person_->advance(clock_.now());
      auto length = below_->read(report, milliseconds(0));
      if (!length || *length > 0 || std::chrono::steady_clock::now() >= until) return length;
      std::this_thread::sleep_for(milliseconds(1));
    }
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
  std::shared_ptr<SimulatedDevice> person_;
  std::unique_ptr<Transport> below_;
  const Clock& clock_;
};

}  // namespace

Result<std::unique_ptr<SimulatedDevice>> make_wire_person(std::string_view driver, WireOptions options,
                                                          const Clock& clock) {
  const Script& script = options.script;
  const bool hands = !script.hands.empty() || script.visitor || script.bystanders > 0;
  const bool puck = driver == "spacemouse" || driver == "spacenav";
  const bool head = driver == "opentrack" || driver == "vrpn" || driver == "rift" || driver == "xreal";
  if (!puck && !head && driver != "leap")
    return fail(ErrorKind::kUsage,
                "simulate: \"{}\" found, expected spacemouse, spacenav, opentrack, vrpn, rift, xreal or leap", driver);
  if (script.visitor && !options.seen && !head)
    return fail(ErrorKind::kUsage, "simulate {}: the script has a visitor, who needs a view to look at (dubsar view)",
                driver);
  if (head && script.heads.empty()) return fail(ErrorKind::kUsage, "simulate {}: the script has no head", driver);
  if (!head && !hands) return fail(ErrorKind::kUsage, "simulate {}: the script has no hands", driver);
  if (head) options.script.visitor.reset();
  if (driver == "spacemouse") return make_spacemouse_wire(std::move(options));
  if (driver == "spacenav") return make_spacenav_wire(std::move(options));
  if (driver == "opentrack") return make_opentrack_wire(std::move(options));
  if (driver == "vrpn") return make_vrpn_wire(std::move(options));
  if (driver == "rift") return make_rift_wire(std::move(options));
  if (driver == "xreal") return make_xreal_wire(std::move(options));
  return make_leap_wire(std::move(options), clock);
}

OpenTransport reach_wire_person(std::shared_ptr<SimulatedDevice> person, const Clock& clock) {
  return [person = std::move(person), &clock]() -> Result<std::unique_ptr<Transport>> {
    DUBSAR_ASSIGN(auto below, person->open());
    return std::make_unique<PersonTransport>(person, std::move(below), clock);
  };
}

Script somebody(std::uint64_t seed, double seconds) {
  Script script;
  script.seed = seed;
  script.duration_s = seconds;
  script.latency_s = 0.0;
  ScriptRandom random(seed);
  HeadTrack head;
  for (double t = 0.0; t < seconds; t += random.uniform(0.6, 1.5))
    head.keys.push_back({t, {random.uniform(-0.12, 0.12), random.uniform(-0.03, 0.06), random.uniform(0.5, 0.7)}});
  head.keys.push_back({seconds, head.keys.back().at_m});
  script.heads.push_back(std::move(head));
  HandTrack hand;
  const auto spot = [&] {
    return glm::dvec3(random.uniform(-0.08, 0.08), random.uniform(-0.03, 0.06), random.uniform(0.12, 0.2));
  };
  HandKey key{0.0, spot()};
  hand.keys.push_back(key);
  for (int i = 0; key.t_s < seconds; ++i) {
    key.t_s = std::min(seconds, key.t_s + random.uniform(0.4, 0.9));
    const bool closing = i % 4 == 0, opening = i % 4 == 2;
    if (closing || opening) {
      key.grab = closing ? 1.0 : 0.0;
      key.pinch_m = closing ? 0.015 : 0.06;
    } else {
      key.at_m = spot();
    }
    hand.keys.push_back(key);
  }
  script.hands.push_back(std::move(hand));
  return script;
}

}  // namespace dubsar
