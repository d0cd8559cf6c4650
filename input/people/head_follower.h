#pragma once
// From heads that a tracker sees to the two eyes that cameras are made for, at the time the picture will be seen.

#include <glm/vec3.hpp>
#include <optional>

#include "input/input_source.h"
#include "input/people/eye_pair.h"
#include "input/people/one_euro.h"
#include "input/people/pose_history.h"
#include "input/people/presence.h"

namespace dubsar {

struct FollowedEyes {
  glm::dvec3 left_m{-0.0315, 0.0, 0.6}, right_m{0.0315, 0.0, 0.6};
  Presence presence = Presence::kOff;
  TimestampNs measured = 0;  ///< device time of the newest measurement used
};

struct HeadFollowOptions {
  glm::dvec3 rest_m{0.0, 0.0, 0.6};  ///< where the eyes are when nobody is seen
  double ipd_m = 0.063;
  OneEuroOptions filter{3.0, 60.0, 3.0};    ///< 12 ms of lag at 200 mm/s, which the prediction makes up for
  TimestampNs most_ahead_ns = 100'000'000;  ///< never predict further
  /// A head that is seen again is gone to at this speed, in 100 ms to 1 s: as quick as heads move by themselves.
  double return_mps = 0.45;
  PresenceOptions presence{};
};

/// The head's centre is filtered (One-Euro) and predicted along the line of its last 100 ms, over the tracker's lag and
/// the filter's own; the vector between the eyes is kept through single-eye dropouts. One thread.
class HeadFollower {
 public:
  explicit HeadFollower(const HeadFollowOptions& options = {});

  /// Where the eyes go when nobody is seen, from now on.
  void set_rest(const glm::dvec3& rest_m) { options_.rest_m = rest_m; }
  /// The kept head, heard of at `now`. Samples whose time does not advance are ignored. After a time without any, the
  /// eyes go to it from where they were: no jump.
  void add(const HeadFrame& head, TimestampNs now);
  /// Eyes at `display_time`; `now` decides how old the last measurement is.
  FollowedEyes eyes(TimestampNs now, TimestampNs display_time) const;

 private:
  struct Return {                           ///< from where the eyes were to a head that is seen again
    glm::dvec3 centre_m{0.0}, half_m{0.0};  ///< how far they are off yet, at `since`
    TimestampNs since = 0, duration = 1;
  };
  struct Eyes {
    glm::dvec3 centre_m, half_m;  ///< half: from the centre to the right eye
    Presence presence;
  };
  Eyes look(TimestampNs now, TimestampNs display_time) const;

  HeadFollowOptions options_;
  EyePairKeeper pair_;
  OneEuroVector filter_;
  PositionHistory history_;
  glm::dvec3 half_m_;  // from the centre to the right eye
  double filter_lag_s_ = 0.0;
  Return return_;
};

}  // namespace dubsar
