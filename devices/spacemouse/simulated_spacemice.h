#pragma once
// A person with a hand on the cap of a SpaceMouse, by cable or through spacenavd.

#include "devices/simulated_device.h"

namespace dubsar {

std::unique_ptr<SimulatedDevice> simulate_spacemouse(const Simulation& simulation);
std::unique_ptr<SimulatedDevice> simulate_spacenav(const Simulation& simulation);

}  // namespace dubsar
