#pragma once
// Hands over a Leap Motion Controller, without the vendor's service.

#include "input/input_source.h"

namespace dubsar {

/// Options: at, turn (input/placement.h; unless told table_placement()), exposure_us, replay, speed, simulate, seed.
/// The pictures are read on the driver's thread; the hands are found on the source's own, always in the newest picture.
Result<std::unique_ptr<InputSource>> make_leap_source(const InputConfig& config);

}  // namespace dubsar
