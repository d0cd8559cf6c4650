#pragma once
// Every hand that is tracked and how it stands to the object: what a screen shows people of themselves.

#include <array>
#include <cstdint>
#include <vector>

#include "input/gestures/gesture.h"
#include "input/people/person_keeper.h"

namespace dubsar {

/// From the best to the worst.
enum class HandState : std::uint8_t {
  kHolding,   ///< it grabs or pinches
  kReady,     ///< it may take hold
  kFist,      ///< it came in closed, and must open before it can take hold
  kTooFar,    ///< outside the zone
  kStranger,  ///< inside, of somebody who is not followed now
};

struct HandMark {
  glm::dvec3 place_m{0.0};  ///< of the palm, in the screen frame; steadied where the hand is followed
  double closing = 0.0;     ///< 0: open, 1: a fist
  double resting = 0.0;     ///< 0..1: how much of a selection by holding still is over
  HandState state = HandState::kReady;
  bool operator==(const HandMark&) const = default;
};

/// Whether a place is inside.
bool in_zone(const HandZone& zone, const glm::dvec3& at_m) noexcept;

/// One mark for each hand of `frame` that is tracked now, those of the followed person first. `hands` are the gestures
/// of person.hands, after their update.
std::vector<HandMark> hand_marks(const InputFrame& frame, const KeptPerson& person,
                                 const std::array<GestureRecognizer, 2>& hands, const HandZone& zone);

}  // namespace dubsar
