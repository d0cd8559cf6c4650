#pragma once
// Recordings made without a device: a scripted person as the wire bytes of any driver, for tests and
// demonstrations.

#include <filesystem>

#include "input/simulated/simulated_feed.h"

namespace dubsar {

/// Writes what the device and its driver say to each other while the person acts, in simulated time; returns
/// the number of events. The same script gives the same bytes. Errors as simulate_device() and RecordingWriter; kUsage:
/// longer than the driver's longest_simulation_s.
Result<std::int64_t> write_simulated_recording(const DriverEntry& driver, const std::filesystem::path& path,
                                               PersonOptions options);

}  // namespace dubsar
