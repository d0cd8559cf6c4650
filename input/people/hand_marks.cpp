#include "input/people/hand_marks.h"

#include <algorithm>

namespace dubsar {

bool in_zone(const HandZone& zone, const glm::dvec3& at_m) noexcept {
  for (int a = 0; a < 3; ++a)
    if (at_m[a] < zone.min_m[a] || at_m[a] > zone.max_m[a]) return false;
  return true;
}

std::vector<HandMark> hand_marks(const InputFrame& frame, const KeptPerson& person,
                                 const std::array<GestureRecognizer, 2>& hands, const HandZone& zone) {
  std::vector<HandMark> out;
  for (std::size_t s = 0; s < hands.size(); ++s) {
    const HandFrame* const hand = person.hands[s];
    const GestureRecognizer& gestures = hands[s];
    if (hand == nullptr || !hand->tracked || !gestures.present()) continue;
    HandMark mark{gestures.position_m(), hand->grab_strength, gestures.dwell_progress()};
    if (gestures.grabbing() || gestures.pinching())
      mark.state = HandState::kHolding;
    else if (!gestures.may_grab())
      mark.state = HandState::kFist;
    out.push_back(mark);
  }
  for (const HandFrame& hand : frame.hands) {
    const bool followed =
        std::any_of(person.hands.begin(), person.hands.end(), [&](const HandFrame* kept) { return kept == &hand; });
    if (followed || !hand.valid || !hand.tracked) continue;
    out.push_back({hand.palm.position_m, hand.grab_strength, 0.0,
                   in_zone(zone, hand.palm.position_m) ? HandState::kStranger : HandState::kTooFar});
  }
  return out;
}

}  // namespace dubsar
