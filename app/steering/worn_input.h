#pragma once
// From what a headset tells of its wearer to what an input source reads: both know nothing of each other.

#include "display/headset/headset.h"
#include "input/worn_feed.h"

namespace dubsar::app {

/// Joints of the hands that are seen, and controllers; screen frame.
WornSample worn_sample(const WearerFrame& wearer);

}  // namespace dubsar::app
