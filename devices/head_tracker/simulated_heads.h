#pragma once
// A person before a head tracker, or with glasses on.

#include "devices/simulated_device.h"

namespace dubsar {

/// The place of the head; nothing while one of its eyes is not seen.
std::unique_ptr<SimulatedDevice> simulate_opentrack(const Simulation& simulation);
std::unique_ptr<SimulatedDevice> simulate_vrpn(const Simulation& simulation);
/// The head looks at the panel's centre.
std::unique_ptr<SimulatedDevice> simulate_rift(const Simulation& simulation);
std::unique_ptr<SimulatedDevice> simulate_xreal(const Simulation& simulation);

}  // namespace dubsar
