#include "devices/head_tracker/simulated_heads.h"

#include <cmath>

#include "devices/head_tracker/imu_sim.h"
#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/vrpn_server.h"
#include "devices/transport/sim_transport.h"

namespace dubsar {
namespace {

/// A tracker that measures place and direction.
class SimulatedTracker : public PacedDevice {
 public:
  explicit SimulatedTracker(const Simulation& simulation)
      : PacedDevice(simulation), tracker_from_screen_(inverse(simulation.screen_from_device)) {}

 protected:
  virtual void send(const Pose& head, TimestampNs time) = 0;

 private:
  void say(const SimulatedPerson& person, bool fresh) final {
    if (!fresh) return;
    if (const auto head = person.head()) send(compose(tracker_from_screen_, *head), person.time());
  }
  Pose tracker_from_screen_;
};

class SimulatedOpentrack final : public SimulatedTracker {
 public:
  using SimulatedTracker::SimulatedTracker;
  Result<std::unique_ptr<Transport>> open() override { return device_.open(); }

 private:
  void send(const Pose& head, TimestampNs) override { device_.send(format_opentrack(opentrack_packet(head))); }
  SimDevice device_{"simulated opentrack"};
};

class SimulatedVrpn final : public SimulatedTracker {
 public:
  explicit SimulatedVrpn(const Simulation& simulation) : SimulatedTracker(simulation) {
    SimBehaviour behaviour;
    behaviour.on_write = [this](std::span<const std::byte> bytes) -> Result<void> {
      DUBSAR_ASSIGN(const auto answer, side_.accept(bytes));
      if (!answer.empty()) device_.send(answer);
      return {};
    };
    device_.set_behaviour(std::move(behaviour));
  }
  Result<std::unique_ptr<Transport>> open() override {
    side_ = VrpnServerSide(kTracker);
    return device_.open();
  }

 private:
  static constexpr const char* kTracker = "Tracker0";
  void send(const Pose& head, TimestampNs time) override {
    if (const auto message = side_.pose(time, head); !message.empty()) device_.send(message);
  }
  VrpnServerSide side_{kTracker};
  SimDevice device_{"simulated VRPN", false};
};

constexpr TimestampNs kSampleNs = 1'000'000;

/// Axis times angle, the short way round.
glm::dvec3 rotation_vector(glm::dquat q) {
  if (q.w < 0) q = -q;
  const glm::dvec3 v(q.x, q.y, q.z);
  const double length = glm::length(v);
  return length > 1e-12 ? v * (2.0 * std::atan2(length, q.w) / length) : 2.0 * v;
}

/// Glasses with inertial sensors. `Sim` takes turn rates; `kSamples` readings make one report.
template <class Sim, int kSamples>
class SimulatedGlasses final : public PacedDevice {
 public:
  template <class... Args>
  explicit SimulatedGlasses(const Simulation& simulation, Args... args)
      : PacedDevice(simulation, kSamples * kSampleNs), sim_(args...) {}
  Result<std::unique_ptr<Transport>> open() override { return sim_.device().open(); }

 private:
  void say(const SimulatedPerson& person, bool) override {
    const glm::dquat turn = person.gaze();
    const glm::dvec3 rate =
        rotation_vector(glm::conjugate(last_.value_or(turn)) * turn) / (1e-9 * kSamples * kSampleNs);
    last_ = turn;
    if constexpr (kSamples == 1)
      sim_.step(rate, 1e-9 * kSampleNs);
    else
      sim_.step(rate, kSamples);
  }
  Sim sim_;
  std::optional<glm::dquat> last_;
};

}  // namespace

std::unique_ptr<SimulatedDevice> simulate_opentrack(const Simulation& simulation) {
  return std::make_unique<SimulatedOpentrack>(simulation);
}
std::unique_ptr<SimulatedDevice> simulate_vrpn(const Simulation& simulation) {
  return std::make_unique<SimulatedVrpn>(simulation);
}
std::unique_ptr<SimulatedDevice> simulate_rift(const Simulation& simulation) {
  return std::make_unique<SimulatedGlasses<RiftSim, 2>>(simulation, RiftModel::kDk1);
}
std::unique_ptr<SimulatedDevice> simulate_xreal(const Simulation& simulation) {
  return std::make_unique<SimulatedGlasses<XrealSim, 1>>(simulation);
}

}  // namespace dubsar
