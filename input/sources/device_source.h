#pragma once
// Any device of the table of drivers as a source: its samples become SpaceMice, heads and hands.

#include "devices/drivers.h"
#include "input/input_source.h"

namespace dubsar {

/// Options of all: replay=FILE, speed=FACTOR, simulate=SCRIPT, seed=N, and those of the driver. Heads: at, turn
/// (unless told the driver's usual place), eyes, ipd. Stereo cameras: at, turn; hands are found in the source's thread,
/// always in the newest pictures. Buttons of SpaceMice are keys "puck1", "puck2", ... Touch panels: turn
/// (degrees), device.
Result<std::unique_ptr<InputSource>> make_device_source(const DriverEntry& driver, const InputConfig& config);

}  // namespace dubsar
