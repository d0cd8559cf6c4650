#include "devices/spacemouse/simulated_spacemice.h"

#include "devices/spacemouse/spacemouse_sim.h"
#include "devices/spacemouse/spacenav_server.h"

namespace dubsar {
namespace {

glm::ivec3 raw(const glm::dvec3& share, int full_scale) { return glm::ivec3(glm::round(share * double(full_scale))); }

class SimulatedCap : public PacedDevice {
 public:
  explicit SimulatedCap(const Simulation& simulation) : PacedDevice(simulation) {}

 protected:
  virtual void send(const CapDeflection& cap) = 0;

 private:
  void say(const SimulatedPerson& person, bool fresh) final {
    if (!fresh) return;
    const CapDeflection cap = person.cap();
    if (cap == CapDeflection{} && last_ == CapDeflection{}) return;  // a cap at rest says nothing
    last_ = cap;
    send(cap);
  }
  CapDeflection last_;
};

class SimulatedSpaceMouse final : public SimulatedCap {
 public:
  using SimulatedCap::SimulatedCap;
  Result<std::unique_ptr<Transport>> open() override { return sim_.device().open(); }

 private:
  /// Device axes: x right, y to the user, z down.
  static glm::ivec3 device_axes(const glm::dvec3& v) { return raw({v.x, v.z, -v.y}, kSpaceMouseFullScale); }
  void send(const CapDeflection& cap) override { sim_.move(device_axes(cap.push), device_axes(cap.twist)); }
  SpaceMouseSim sim_;
};

class SimulatedSpacenav final : public SimulatedCap {
 public:
  explicit SimulatedSpacenav(const Simulation& simulation) : SimulatedCap(simulation) {
    SimBehaviour behaviour;
    behaviour.on_write = [this](std::span<const std::byte> bytes) -> Result<void> {
      if (const auto answer = side_.accept(bytes); !answer.empty()) device_.send(answer);
      return {};
    };
    device_.set_behaviour(std::move(behaviour));
  }
  Result<std::unique_ptr<Transport>> open() override {
    side_ = {};
    return device_.open();
  }

 private:
  /// The daemon's axes: z away from the user.
  static glm::ivec3 daemon_axes(const glm::dvec3& v) { return raw({v.x, v.y, -v.z}, kSpacenavFullScale); }
  void send(const CapDeflection& cap) override {
    SpacenavEvent event;
    event.translation = daemon_axes(cap.push);
    event.rotation = daemon_axes(cap.twist);
    event.period_ms = 16;
    if (const auto bytes = side_.tell(event); !bytes.empty()) device_.send(bytes);
  }
  SpacenavServerSide side_;
  SimDevice device_{"simulated spacenavd", false};
};

}  // namespace

std::unique_ptr<SimulatedDevice> simulate_spacemouse(const Simulation& simulation) {
  return std::make_unique<SimulatedSpaceMouse>(simulation);
}
std::unique_ptr<SimulatedDevice> simulate_spacenav(const Simulation& simulation) {
  return std::make_unique<SimulatedSpacenav>(simulation);
}

}  // namespace dubsar
