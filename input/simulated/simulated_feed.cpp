#include "input/simulated/simulated_feed.h"

#include <chrono>
#include <thread>

#include "devices/transport/forwarding_transport.h"

namespace dubsar {
namespace {

class SimulatedTransport final : public ForwardingTransport {
 public:
  SimulatedTransport(std::shared_ptr<SimulatedDevice> device, std::unique_ptr<Transport> below, const Clock& clock)
      : ForwardingTransport(std::move(below)), device_(std::move(device)), clock_(clock) {}

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    const auto until = std::chrono::steady_clock::now() + timeout;
    for (;;) {
      device_->advance(clock_.now());
      auto length = below().read(report, milliseconds(0));
      if (!length || *length > 0 || std::chrono::steady_clock::now() >= until) return length;
      std::this_thread::sleep_for(milliseconds(1));
    }
  }

 private:
  std::shared_ptr<SimulatedDevice> device_;
  const Clock& clock_;
};

}  // namespace

Result<SimulatedFeed> simulate_device(const DriverEntry& driver, PersonOptions options, const Clock& clock) {
  if (!driver.simulate) return fail(ErrorKind::kUsage, "simulate: {} cannot be simulated", driver.name);
  Simulation simulation;
  simulation.screen_from_device = options.screen_from_device;
  simulation.seed = options.script.seed;
  simulation.clock = &clock;
  DUBSAR_ASSIGN(simulation.person, make_scripted_person(driver, std::move(options)));
  return SimulatedFeed{driver.simulate(simulation), simulation.person};
}

OpenTransport open_simulated(std::shared_ptr<SimulatedDevice> device, const Clock& clock) {
  return [device = std::move(device), &clock]() -> Result<std::unique_ptr<Transport>> {
    DUBSAR_ASSIGN(auto below, device->open());
    return std::make_unique<SimulatedTransport>(device, std::move(below), clock);
  };
}

}  // namespace dubsar
