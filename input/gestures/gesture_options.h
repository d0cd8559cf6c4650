#pragma once
// Figures of the gesture recogniser. Defaults are those of shipped systems: grab and swipe of Ultraleap TouchFree,
// pinch of the Ultraleap Unity plug-in.

#include "core/base/clock.h"

namespace dubsar {

struct GestureOptions {
  double grab_on = 0.8, grab_off = 0.7;  ///< grab strength
  /// Who holds the air as an object never makes a fist: a hand that rests and closes by `rise` to at least `gentle`
  /// grabs too, and lets go when it has opened by `let_go` from its closest.
  double grab_gentle = 0.45, grab_rise = 0.28, grab_let_go = 0.2, grab_rest_mps = 0.15;
  /// For places where nobody was told: a hand takes hold only if it was still for so long when it closed, and stays
  /// closed for `grab_sure_ns`; it lets go when it stays open for `grab_open_ns`.
  TimestampNs grab_still_ns = 0, grab_sure_ns = 0, grab_open_ns = 0;
  double pull_start_m = 0.025;  ///< a grabbing hand that moves this far towards its owner or away first, zooms
  double pinch_on_m = 0.025, pinch_off_m = 0.030;  ///< thumb tip to index tip
  double drag_start_m = 0.010;                     ///< a grabbing hand moves this far before anything follows it
  double roll_start_rad = 0.105;                   ///< two hands turn this far before the object rolls
  TimestampNs cooldown_ns = 300'000'000;           ///< nothing begins for this long after a hand came
  TimestampNs hold_ns = 100'000'000;               ///< a hand missing longer than this has lost its gesture
  double swipe_mps = 0.625, swipe_lateral_mps = 0.300, swipe_end_mps = 0.200, swipe_opposing_mps = 0.065;
  TimestampNs swipe_lockout_ns = 450'000'000;
  double swipe_travel_m = 0.010;
  /// Not 0: a swipe is counted when it comes to its end, by an open hand that was still for so long before.
  TimestampNs swipe_still_ns = 0;
  /// Nothing but dwelling begins in this corner of the zone: there are signs to be chosen. To its right, above it.
  double signs_from_x_m = 10.0, signs_from_y_m = 10.0;
  double acts_to_z_m = 10.0;      ///< nor further from the screen than this: hands at the chin hold nothing
  double swipes_within_m = 10.0;  ///< nor is anything wiped further from the middle than this, to any side
  double dwell_radius_m = 0.015;
  TimestampNs dwell_start_ns = 500'000'000, dwell_fill_ns = 600'000'000;
};

}  // namespace dubsar
