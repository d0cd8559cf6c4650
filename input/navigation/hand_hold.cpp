#include "input/navigation/hand_hold.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

namespace dubsar {
namespace {

constexpr double kPullsRatherThanTurns = 1.5;  // of the way to the side
constexpr double kPullPerMetre = 7.0;          // logarithm of the zoom: a forearm's way is a factor of 3
constexpr double kShortestSpanM = 0.02;
// Of a real hand before a tracker (closing_fingers.h): its palm goes on at .02 to .07 m/s when the fingers are there.
constexpr double kCreepMps = 0.07, kClosingCreepMps = 0.15;

}  // namespace

std::optional<HandMode> HandHold::wanted(const Hands& hands, const HandMapping& mapping) {
  const bool grab0 = hands[0].grabbing(), grab1 = hands[1].grabbing();
  HandMode wanted = HandMode::kNone;
  if (grab0 && grab1 && mapping.two_hands != Action::kNone) {
    wanted = needs_new_grab_ ? HandMode::kNone : HandMode::kTwoGrabs;
  } else if (grab0 || grab1) {
    wanted = needs_new_grab_ || mapping.grab == Action::kNone ? HandMode::kNone : HandMode::kOneGrab;
  } else if (mapping.pinch != Action::kNone && (hands[0].pinching() || hands[1].pinching())) {
    wanted = HandMode::kPinch;
  }
  if (mode_ == HandMode::kTwoGrabs && wanted == HandMode::kOneGrab) {
    needs_new_grab_ = true;
    wanted = HandMode::kNone;
  }
  const bool same_hand = wanted == HandMode::kTwoGrabs || wanted == HandMode::kNone ||
                         (wanted == HandMode::kPinch ? hands[leading_].pinching() : hands[leading_].grabbing());
  if (wanted == mode_ && same_hand) return std::nullopt;
  return wanted;
}

void HandHold::let_go() {
  mode_ = HandMode::kNone;
  past_dead_zone_ = rolls_ = zooms_ = pulls_ = false;
}

void HandHold::take_away() {
  if (mode_ != HandMode::kNone) needs_new_grab_ = true;
  mode_ = HandMode::kNone;
}

void HandHold::begin(HandMode mode, const Hands& hands) {
  mode_ = mode;
  if (mode == HandMode::kTwoGrabs) {
    const glm::dvec2 between(hands[1].position_m() - hands[0].position_m());
    span_m_ = glm::length(between);
    angle_rad_ = std::atan2(between.y, between.x);
  } else {
    const bool first = mode == HandMode::kPinch ? hands[0].pinching() : hands[0].grabbing();
    leading_ = first ? 0 : 1;
    anchor_m_ = hands[leading_].position_m();
  }
}

HandPull HandHold::follow(const Hands& hands, const Mapping& mapping) {
  if (mode_ == HandMode::kNone) return {};
  return mode_ == HandMode::kTwoGrabs ? follow_two(hands, mapping) : follow_one(hands[leading_], mapping);
}

HandPull HandHold::follow_one(const GestureRecognizer& hand, const Mapping& mapping) {
  HandPull out;
  if (!hand.seen_now()) return out;
  // The palm creeps on as fingers close round nothing: that is no drag.
  const double creeps = hand.fingers_close() ? kClosingCreepMps : kCreepMps;
  if (!past_dead_zone_ && mapping.gestures.grab.still_ns > 0 && glm::length(hand.velocity_mps()) < creeps) {
    anchor_m_ = hand.position_m();
    return out;
  }
  const bool grabs = mode_ == HandMode::kOneGrab, may_pull = grabs && mapping.hands.pull != Action::kNone;
  const glm::dvec3 moved = hand.position_m() - anchor_m_;
  const double sideways = std::hypot(moved.x, moved.y);
  const bool deep = std::abs(moved.z) > kPullsRatherThanTurns * sideways;
  if (!past_dead_zone_ && may_pull && !pulls_) pulls_ = std::abs(moved.z) >= mapping.gestures.held.pull_start_m && deep;
  if (pulls_) {
    if (past_dead_zone_) out.zoom = kPullPerMetre * moved.z;
    past_dead_zone_ = true;
    anchor_m_ = hand.position_m();
    return out;
  }
  if (!past_dead_zone_ && grabs && sideways < mapping.gestures.held.drag_start_m) return out;
  if (!past_dead_zone_ && may_pull && deep) return out;  // not decided yet
  anchor_m_ = hand.position_m();
  if (std::exchange(past_dead_zone_, true) || !grabs) out.dragged_m = glm::dvec2(moved);
  return out;
}

HandPull HandHold::follow_two(const Hands& hands, const Mapping& mapping) {
  HandPull out;
  if (!hands[0].seen_now() && !hands[1].seen_now()) return out;
  const glm::dvec2 between = glm::dvec2(hands[1].position_m() - hands[0].position_m());
  const double span = glm::length(between);
  if (span < kShortestSpanM) return out;
  const double turned = std::remainder(std::atan2(between.y, between.x) - angle_rad_, 2.0 * std::numbers::pi);
  if (!zooms_ && std::abs(span - span_m_) >= mapping.gestures.held.drag_start_m) {
    zooms_ = true;
    span_m_ = span;
  } else if (zooms_) {
    out.zoom = std::log(span / span_m_);
    span_m_ = span;
  }
  if (mapping.hands.two_hands != Action::kZoomAndRoll) return out;
  if (!rolls_ && std::abs(turned) >= mapping.gestures.held.roll_start_rad) {
    rolls_ = true;
    angle_rad_ += turned;
  } else if (rolls_) {
    out.roll_rad = turned;
    angle_rad_ += turned;
  }
  return out;
}

}  // namespace dubsar
