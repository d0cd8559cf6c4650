#include "devices/leap/simulated_leap.h"

#include "devices/leap/lmc1_simulator.h"

namespace dubsar {
namespace {

constexpr double kOpenPinch_m = 0.06, kClosedPinch_m = 0.015, kPinchFlexion = 0.45;

PosedHand posed(const ShownHand& hand, const Pose& device_from_screen) {
  HandPose pose;
  pose.palm = compose(device_from_screen, hand.palm);
  pose.flexion.fill(hand.grab);
  const double pinch = std::clamp((kOpenPinch_m - hand.pinch_m) / (kOpenPinch_m - kClosedPinch_m), 0.0, 1.0);
  for (const std::size_t finger : {0U, 1U})
    pose.flexion[finger] = std::max(pose.flexion[finger], kPinchFlexion * pinch);
  pose.left = hand.left;
  return pose_hand(pose);
}

class SimulatedLeap final : public SimulatedDevice {
 public:
  explicit SimulatedLeap(const Simulation& simulation)
      : clock_(*simulation.clock),
        device_from_screen_(inverse(simulation.screen_from_device)),
        person_(simulation.person) {
    Lmc1SimulatorOptions device;
    device.seed = simulation.seed;
    device.paced = true;
    device.clock = &clock_;
    device.hands = [this](std::uint64_t) { return hands_now(); };
    simulator_.emplace(device);
  }
  void advance(TimestampNs) override {}
  Result<std::unique_ptr<Transport>> open() override { return simulator_->open(); }

 private:
  std::vector<PosedHand> hands_now() {
    person_->act(clock_.now());
    std::vector<PosedHand> out;
    for (const ShownHand& hand : person_->hands()) out.push_back(posed(hand, device_from_screen_));
    return out;
  }
  const Clock& clock_;
  const Pose device_from_screen_;
  std::shared_ptr<SimulatedPerson> person_;
  std::optional<Lmc1Simulator> simulator_;
};

}  // namespace

std::unique_ptr<SimulatedDevice> simulate_leap(const Simulation& simulation) {
  return std::make_unique<SimulatedLeap>(simulation);
}

}  // namespace dubsar
