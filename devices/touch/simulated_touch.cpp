#include "devices/touch/simulated_touch.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

namespace dubsar {
namespace {

constexpr std::int32_t kWidth = 3440, kHeight = 1940;  // tenths of a millimetre
constexpr std::int32_t kLargestId = 65535;
constexpr double kGrabs = 0.8;
const glm::dvec2 kPanelM{1e-4 * kWidth, 1e-4 * kHeight};

}  // namespace

struct TouchPanelSim::Panel {
  std::mutex mutex;
  EvdevAxis slot{0, 0, static_cast<std::int32_t>(kSlots) - 1, {}};
  EvdevAxis id{0, 0, kLargestId, std::vector<std::int32_t>(kSlots, -1)};
  EvdevAxis x{0, 0, kWidth, std::vector<std::int32_t>(kSlots, 0)};
  EvdevAxis y{0, 0, kHeight, std::vector<std::int32_t>(kSlots, 0)};
  std::array<std::optional<std::uint32_t>, kSlots> fingers{};  ///< whose finger is in a slot
  std::int32_t next_id = 0;
  TimestampNs time = 0;
  std::vector<EvdevEvent> events{};

  void say(std::size_t in_slot, std::uint16_t code, EvdevAxis& axis, std::int32_t value) {
    if (axis.slots[in_slot] == value) return;
    const auto number = static_cast<std::int32_t>(in_slot);
    if (slot.value != number) events.push_back({time, kEvAbs, kMtSlot, number});
    slot.value = number;
    axis.slots[in_slot] = value;
    events.push_back({time, kEvAbs, code, value});
  }
  void move(std::size_t in_slot, const glm::dvec2& at) {
    say(in_slot, kMtX, x, static_cast<std::int32_t>(std::lround(std::clamp(at.x, 0.0, 1.0) * kWidth)));
    say(in_slot, kMtY, y, static_cast<std::int32_t>(std::lround(std::clamp(at.y, 0.0, 1.0) * kHeight)));
  }
  std::optional<std::vector<std::byte>> answer(std::uint8_t code) {
    const std::lock_guard lock(mutex);
    if (code == kMtSlot) return format_evdev_axis(code, slot);
    if (code == kMtTrackingId) return format_evdev_axis(code, id);
    if (code == kMtX) return format_evdev_axis(code, x);
    if (code == kMtY) return format_evdev_axis(code, y);
    return std::nullopt;
  }
};

TouchPanelSim::TouchPanelSim() : panel_(std::make_shared<Panel>()), device_("simulated touch panel") {
  SimBehaviour behaviour;
  behaviour.on_get_feature = [panel = panel_](std::uint8_t code) -> Result<std::vector<std::byte>> {
    if (auto answer = panel->answer(code)) return *std::move(answer);
    return fail(ErrorKind::kBadData, "simulated touch panel: axis {:#x} asked for, which it does not have", code);
  };
  device_.set_behaviour(std::move(behaviour));
}

void TouchPanelSim::touch(TimestampNs time, const std::map<std::uint32_t, glm::dvec2>& fingers) {
  std::vector<EvdevEvent> events;
  {
    const std::lock_guard lock(panel_->mutex);
    Panel& panel = *panel_;
    panel.time = time;
    for (std::size_t s = 0; s < kSlots; ++s)
      if (panel.fingers[s] && fingers.count(*panel.fingers[s]) == 0) {
        panel.say(s, kMtTrackingId, panel.id, -1);
        panel.fingers[s].reset();
      }
    for (const auto& [finger, at] : fingers) {
      auto* found = std::find(panel.fingers.begin(), panel.fingers.end(), std::optional(finger));
      if (found == panel.fingers.end()) {
        found = std::find(panel.fingers.begin(), panel.fingers.end(), std::nullopt);
        if (found == panel.fingers.end()) continue;
        *found = finger;
        panel.say(static_cast<std::size_t>(found - panel.fingers.begin()), kMtTrackingId, panel.id, panel.next_id);
        panel.next_id = (panel.next_id + 1) % (kLargestId + 1);
      }
      panel.move(static_cast<std::size_t>(found - panel.fingers.begin()), at);
    }
    events.swap(panel.events);
    if (!events.empty()) events.push_back({time, kEvSyn, kSynReport, 0});
  }
  if (!events.empty()) device_.send(format_evdev(events));
}

namespace {

class SimulatedTouch final : public PacedDevice {
 public:
  explicit SimulatedTouch(const Simulation& simulation)
      : PacedDevice(simulation), device_from_screen_(inverse(simulation.screen_from_device)) {}
  Result<std::unique_ptr<Transport>> open() override { return panel_.device().open(); }

 private:
  void say(const SimulatedPerson& person, bool fresh) override {
    if (!fresh) return;
    std::map<std::uint32_t, glm::dvec2> fingers;
    std::uint32_t number = 0;
    for (const ShownHand& hand : person.hands()) {
      const glm::dvec3 at = compose(device_from_screen_, hand.palm).position_m;
      const glm::dvec2 shares(0.5 + at.x / kPanelM.x, 0.5 - at.y / kPanelM.y);
      const bool on_glass = shares.x >= 0.0 && shares.x <= 1.0 && shares.y >= 0.0 && shares.y <= 1.0;
      if (hand.grab >= kGrabs && on_glass) fingers[2 * number + (hand.left ? 1U : 0U)] = shares;
      ++number;
    }
    panel_.touch(person.time(), fingers);
  }
  Pose device_from_screen_;
  TouchPanelSim panel_;
};

}  // namespace

std::unique_ptr<SimulatedDevice> simulate_touch(const Simulation& simulation) {
  return std::make_unique<SimulatedTouch>(simulation);
}

}  // namespace dubsar
