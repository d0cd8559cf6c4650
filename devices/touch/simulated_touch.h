#pragma once
// A touch panel in memory, event for event, and a person before it.

#include <cstdint>
#include <map>
#include <memory>

#include "devices/simulated_device.h"
#include "devices/touch/evdev_event.h"
#include "devices/transport/sim_transport.h"

namespace dubsar {

/// What a kernel driver of type B says: only what has changed, each finger in a slot of its own. touch() from one
/// thread, the host's end from another.
class TouchPanelSim {
 public:
  static constexpr std::size_t kSlots = 10;
  TouchPanelSim();
  /// The fingers that are on the glass from now on, by any numbers of theirs; places are shares of the panel from its
  /// upper left corner. More than there are slots are not felt.
  void touch(TimestampNs time, const std::map<std::uint32_t, glm::dvec2>& fingers);
  SimDevice& device() noexcept { return device_; }

 private:
  struct Panel;
  std::shared_ptr<Panel> panel_;  // the host asks for it
  SimDevice device_;
};

/// Each hand that grabs has a finger on the glass, before the middle of its palm.
std::unique_ptr<SimulatedDevice> simulate_touch(const Simulation& simulation);

}  // namespace dubsar
