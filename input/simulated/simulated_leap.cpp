// People before a Leap Motion Controller, as the pictures that it sends.

#include <algorithm>

#include "devices/leap/lmc1_simulator.h"
#include "input/simulated/scripted_wire.h"

namespace dubsar {
namespace {

constexpr double kOpenPinch_m = 0.06, kClosedPinch_m = 0.015, kPinchFlexion = 0.45;

PosedHand posed(const HandFrame& hand, const Pose& device_from_screen) {
  HandPose pose;
  pose.palm = compose(device_from_screen, hand.palm);
  pose.flexion.fill(hand.grab_strength);
  const double pinch = std::clamp((kOpenPinch_m - hand.pinch_distance_m) / (kOpenPinch_m - kClosedPinch_m), 0.0, 1.0);
  for (const std::size_t finger : {0U, 1U})
    pose.flexion[finger] = std::max(pose.flexion[finger], kPinchFlexion * pinch);
  pose.left = hand.chirality == Chirality::kLeft;
  return pose_hand(pose);
}

class LeapWire final : public SimulatedDevice {
 public:
  LeapWire(WireOptions options, const Clock& clock)
      : clock_(clock), device_from_screen_(inverse(options.screen_from_device)), seen_(std::move(options.seen)) {
    options.script.latency_s = 0.0;  // the pictures have their own way to go
    Lmc1SimulatorOptions device;
    device.seed = options.script.seed;
    device.paced = true;
    device.clock = &clock;
    device.hands = [this](std::uint64_t) { return hands_now(); };
    actor_ = play_script(std::move(options.script), [this] { return view_; }).value();
    simulator_.emplace(std::move(device));
  }
  void advance(TimestampNs) override {}  // the device keeps its own pace
  Result<std::unique_ptr<Transport>> open() override { return simulator_->open(); }

 private:
  /// In the thread that reads the device.
  std::vector<PosedHand> hands_now() {
    if (seen_) view_ = seen_->look();
    actor_->poll(clock_.now(), frame_);
    if (actor_->finished()) end();
    std::vector<PosedHand> out;
    for (const HandFrame& hand : frame_.hands) out.push_back(posed(hand, device_from_screen_));
    return out;
  }
  const Clock& clock_;
  const Pose device_from_screen_;
  std::shared_ptr<const SeenView> seen_;
  ViewState view_{};
  std::unique_ptr<InputSource> actor_;
  InputFrame frame_;
  std::optional<Lmc1Simulator> simulator_;
};

}  // namespace

std::unique_ptr<SimulatedDevice> make_leap_wire(WireOptions options, const Clock& clock) {
  return std::make_unique<LeapWire>(std::move(options), clock);
}

}  // namespace dubsar
