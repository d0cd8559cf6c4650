#pragma once
// People before a Leap Motion Controller, as the pictures that it sends.

#include "devices/simulated_device.h"

namespace dubsar {

/// It keeps its own pace, on the simulation's clock.
std::unique_ptr<SimulatedDevice> simulate_leap(const Simulation& simulation);

}  // namespace dubsar
