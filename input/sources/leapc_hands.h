#pragma once
// From LeapC's hands to ours.

#include "devices/leap/leapc_protocol.h"
#include "input/hand_frame.h"

namespace dubsar {

/// All 26 joints of a hand in the device's frame, metres. The library's thumb has a metacarpal of no length:
/// its three real bones are taken. Pinch is the distance of the tips of thumb and index finger, since the
/// library's pinch strength rises for any finger. A rotation that is not one is made from the bone's
/// direction and the palm.
HandFrame hand_from_leapc(const leapc::Hand& hand, TimestampNs time);

}  // namespace dubsar
