#pragma once
// Hands of Ultraleap's own tracking service as an input source: for devices that only it can read, and for
// its accuracy.

#include <memory>

#include "devices/leap/leapc_connection.h"
#include "input/input_source.h"

namespace dubsar {

/// Options: library=FILE, mode=desktop|screentop|headmounted, at=X/Y/Z, turn=X/Y/Z (OptionReader::placement).
/// kUsage for others. start() is kUnavailable when there is no library (it says where it looked). A service
/// or a device that is missing makes the source lost, with what to do in note(); it comes back by itself.
Result<std::unique_ptr<InputSource>> make_leapc_source(const InputConfig& config);

/// The source over a connection that is not started yet; hands are moved from the device's frame to the
/// screen's. A device that sends nothing for kLeapcSilentNs is lost. `simulated_time`: the service measures
/// on a clock that has nothing to do with the session's, so that hands bear the time at which they are
/// polled, and silence means nothing.
std::unique_ptr<InputSource> leapc_source(std::unique_ptr<leapc::Connection> connection, const Pose& screen_from_device,
                                          bool simulated_time = false);
inline constexpr TimestampNs kLeapcSilentNs = 1'000'000'000;

}  // namespace dubsar
