#pragma once
// Recordings made without a device: a scripted person as the wire bytes of any driver, for tests and demonstrations.

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// Writes `seconds` of a person who looks about (head trackers) or turns the cap (SpaceMouse) to a recording. Drivers:
/// spacemouse, opentrack, rift, xreal. The same seed gives the same bytes. kUsage for other drivers.
Result<std::int64_t> write_simulated_recording(std::string_view driver, const std::filesystem::path& path,
                                               double seconds, std::uint64_t seed);

}  // namespace dubsar
