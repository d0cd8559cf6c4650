#pragma once
// A hand that tests move by hand, 100 samples a second.

#include <algorithm>
#include <vector>

#include "input/gestures/gesture.h"
#include "input/navigation/mapping.h"
#include "tests/input/milliseconds.h"

namespace dubsar::test {

inline constexpr TimestampNs kStep = 10 * kMs;

/// Fists only.
inline GestureOptions firm() {
  GestureOptions options;
  options.grab.gentle = 2.0;
  return options;
}

/// As galleries have it, where nobody was told.
inline GestureOptions gallery() { return gallery_mapping().value().gestures; }

/// A hand that is moved by hand, 100 samples a second.
struct Person {
  GestureRecognizer recognizer;
  HandFrame hand;
  HandStanding standing{.sure = true};
  TimestampNs now = 0;
  std::vector<GestureEvent> events;

  explicit Person(const GestureOptions& options = firm()) : recognizer(options) {
    hand.valid = hand.tracked = true;
    hand.palm.position_m = {0, 0, 0.3};
    hand.pinch_distance_m = 0.06;
  }
  void step(bool seen = true) {
    now += kStep;
    hand.time = now;
    recognizer.update(now, seen ? &hand : nullptr, standing);
    events.insert(events.end(), recognizer.events().begin(), recognizer.events().end());
  }
  void steps(int n, bool seen = true) {
    for (int i = 0; i < n; ++i) step(seen);
  }
  void move(const glm::dvec3& velocity_mps, int n) {
    for (int i = 0; i < n; ++i) {
      hand.palm.position_m += velocity_mps * 0.01;
      step();
    }
  }
  int count(GestureKind kind, GesturePhase phase) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(),
                                          [&](const GestureEvent& e) { return e.kind == kind && e.phase == phase; }));
  }
};

/// The index finger as joints, its tip so far from its knuckle.
inline void set_index(HandFrame& hand, double tip_m) {
  hand.joint(HandJoint::kWrist) = {Pose{{0, 0, 0.36}, {1, 0, 0, 0}}, 0.01, true, true};
  hand.joint(HandJoint::kIndexProximal) = {Pose{{0, 0, 0.26}, {1, 0, 0, 0}}, 0.01, true, true};
  hand.joint(HandJoint::kIndexTip) = {Pose{{0, 0, 0.26 - tip_m}, {1, 0, 0, 0}}, 0.01, true, true};
}

}  // namespace dubsar::test
