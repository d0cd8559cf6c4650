// A person before a head tracker that measures place and direction.

#include <algorithm>

#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/vrpn_server.h"
#include "devices/transport/sim_transport.h"
#include "input/simulated/scripted_wire.h"

namespace dubsar {
namespace {

/// The first head of the script in the tracker's frame, facing along the screen's axis; nothing while an eye
/// is not seen.
std::optional<Pose> tracked_head(const InputFrame& frame, const Pose& screen_from_tracker) {
  const auto head = std::find_if(frame.heads.begin(), frame.heads.end(), [](const HeadFrame& h) { return h.id == 0; });
  if (head == frame.heads.end() || !head->left_eye_m || !head->right_eye_m) return std::nullopt;
  return compose(inverse(screen_from_tracker), {0.5 * (*head->left_eye_m + *head->right_eye_m), {1, 0, 0, 0}});
}

class OpentrackWire final : public ScriptedWire {
 public:
  explicit OpentrackWire(WireOptions options) : ScriptedWire(options), place_(options.screen_from_device) {}
  Result<std::unique_ptr<Transport>> open() override { return device_.open(); }

 private:
  void say(const InputFrame& frame) override {
    if (const auto pose = tracked_head(frame, place_)) device_.send(format_opentrack(opentrack_packet(*pose)));
  }
  Pose place_;
  SimDevice device_{"simulated opentrack"};
};

class VrpnWire final : public ScriptedWire {
 public:
  explicit VrpnWire(WireOptions options) : ScriptedWire(options), place_(options.screen_from_device) {
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
  void say(const InputFrame& frame) override {
    const auto pose = tracked_head(frame, place_);
    if (!pose) return;
    if (const auto message = side_.pose(frame.time, *pose); !message.empty()) device_.send(message);
  }
  Pose place_;
  VrpnServerSide side_{kTracker};
  SimDevice device_{"simulated VRPN", false};
};

}  // namespace

std::unique_ptr<SimulatedDevice> make_opentrack_wire(WireOptions options) {
  return std::make_unique<OpentrackWire>(std::move(options));
}
std::unique_ptr<SimulatedDevice> make_vrpn_wire(WireOptions options) {
  return std::make_unique<VrpnWire>(std::move(options));
}

}  // namespace dubsar
