#pragma once
// Recordings made without a device: a scripted person as the wire bytes of any driver, for tests and
// demonstrations.

#include <filesystem>
#include <string_view>

#include "input/simulated/simulated_device.h"

namespace dubsar {

/// Writes what the device and its driver say to each other while the person acts, in simulated time; returns
/// the number of events. The same script gives the same bytes. A Leap's pictures take 70 MB a second. Errors
/// as make_wire_person() and RecordingWriter; kUsage: more than 10 s of a Leap.
Result<std::int64_t> write_simulated_recording(std::string_view driver, const std::filesystem::path& path,
                                               WireOptions options);

}  // namespace dubsar
