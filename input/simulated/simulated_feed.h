#pragma once
// A scripted person and the device before which it acts, as a way to open that device.

#include "input/simulated/scripted_person.h"

namespace dubsar {

struct SimulatedFeed {
  std::shared_ptr<SimulatedDevice> device;
  std::shared_ptr<SimulatedPerson> person;
};

/// kUsage: a driver that cannot be simulated; as make_scripted_person(). `clock` outlives it and may be read in any
/// thread.
Result<SimulatedFeed> simulate_device(const DriverEntry& driver, PersonOptions options, const Clock& clock);

/// Reading what this opens lets the person act up to the clock's time.
OpenTransport open_simulated(std::shared_ptr<SimulatedDevice> device, const Clock& clock);

}  // namespace dubsar
