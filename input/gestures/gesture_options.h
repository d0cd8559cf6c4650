#pragma once
// Figures of the gesture recogniser. Defaults are those of shipped systems: grab and swipe of Ultraleap TouchFree,
// pinch of the Ultraleap Unity plug-in.

#include "core/base/system/clock.h"

namespace dubsar {

struct GrabFigures {
  double on = 0.8, off = 0.7;  ///< grab strength
  /// Who holds the air as an object never makes a fist: a hand that rests and closes by `rise` to at least `gentle`
  /// grabs too, and lets go when it has opened by `let_go` from its closest.
  double gentle = 0.45, rise = 0.28, let_go = 0.2, rest_mps = 0.15;
  /// For places where nobody was told: a hand takes hold only if it was still for so long when it closed, and stays
  /// closed for `sure_ns`; it lets go when it stays open for `open_ns`.
  TimestampNs still_ns = 0, sure_ns = 0, open_ns = 0;
  /// Fingers of somebody who has not turned anything yet may open again by so much as they close gently.
  double beginner_slack = 0.0;
};

struct PinchFigures {
  double on_m = 0.025, off_m = 0.030;  ///< thumb tip to index tip
};

/// What a hand that holds does before anything follows it.
struct HeldFigures {
  double pull_start_m = 0.025;    ///< a grabbing hand that moves this far towards its owner or away first, zooms
  double drag_start_m = 0.010;    ///< a grabbing hand moves this far
  double roll_start_rad = 0.105;  ///< two hands turn this far before the object rolls
};

struct SwipeFigures {
  double fast_mps = 0.625, lateral_mps = 0.300, end_mps = 0.200, opposing_mps = 0.065;
  TimestampNs lockout_ns = 450'000'000;
  double travel_m = 0.010;
  /// Not 0: a swipe is counted when it comes to its end, by an open hand that was still for so long before.
  TimestampNs still_ns = 0;
  double within_m = 10.0;  ///< nothing is wiped further from the middle than this, to any side
  /// Nor by a hand that was not seen for so long when it has wiped: it may be of somebody who only reaches in. The
  /// latter for hands whose person is sure (HandStanding).
  TimestampNs known_ns = 0, sure_ns = 0;
};

struct DwellFigures {
  double radius_m = 0.015;
  TimestampNs start_ns = 500'000'000, fill_ns = 600'000'000;
};

/// Where a hand's gestures count, screen frame.
struct ActingPlace {
  /// Nothing but dwelling begins in this corner of the zone while there are signs to be chosen. To its right, above it.
  double signs_from_x_m = 10.0, signs_from_y_m = 10.0;
  double acts_to_z_m = 10.0;  ///< nor further from the screen than this: hands at the chin hold nothing
};

/// What whoever leads the session knows of it.
struct GestureScene {
  bool signs_above = true;  ///< there is a sign in the corner that ActingPlace keeps free
  bool beginner = false;    ///< this person has not turned anything yet
};

struct GestureOptions {
  GrabFigures grab;
  PinchFigures pinch;
  HeldFigures held;
  SwipeFigures swipe;
  DwellFigures dwell;
  ActingPlace place;
  TimestampNs cooldown_ns = 300'000'000;  ///< nothing begins for this long after a hand came
  TimestampNs hold_ns = 100'000'000;      ///< a hand missing longer than this has lost its gesture
};

}  // namespace dubsar
