#include "devices/spacemouse/spacemouse_sim.h"

namespace dubsar {

SpaceMouseSim::SpaceMouseSim(bool combined, UsbId id) : combined_(combined), device_("simulated SpaceMouse", true, id) {
  SimBehaviour behaviour;
  behaviour.on_write = [light = light_](std::span<const std::byte> report) -> Result<void> {
    if (report.size() != 2 || report[0] != std::byte{4})
      return fail(ErrorKind::kIo, "simulated SpaceMouse: output report {} refused, it knows only the light",
                  report.size());
    *light = report[1] != std::byte{0};
    return {};
  };
  device_.set_behaviour(std::move(behaviour));
}

void SpaceMouseSim::move(const glm::ivec3& translation, const glm::ivec3& rotation) {
  for (const auto& report : format_spacemouse({translation, rotation, {}, {}}, combined_)) device_.send(report);
}

void SpaceMouseSim::press(std::uint64_t buttons) {
  for (const auto& report : format_spacemouse({{}, {}, buttons, {}}, combined_)) device_.send(report);
}

}  // namespace dubsar
