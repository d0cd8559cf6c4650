#pragma once
// Hands and controllers of who wears the headset that pictures are made for.

#include <memory>

#include "input/worn_feed.h"

namespace dubsar {

/// Fills palm, pinch, grab and confidence of a hand from its joints: the pinch is the distance of the tips of thumb and
/// index, the grab how far the four fingers are bent between the palm and their ends (30 degrees: 0, 180: 1).
void complete_hand(HandFrame& hand);

/// Options: none. kUnavailable where nothing is worn: expected --display openxr. Hands go to the gestures; a controller
/// that is squeezed steers as a SpaceMouse does, pushed by where it is moved from where the squeeze began (10 cm: all
/// the way) and twisted by how it is turned (45 degrees); its trigger is button 1 of one. Nothing new for 0.5 s: lost.
Result<std::unique_ptr<InputSource>> make_openxr_source(const InputConfig& config);

}  // namespace dubsar
