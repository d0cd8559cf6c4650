#pragma once
// Grab and pinch, each with its hysteresis. Grabbing masks pinching; nothing begins before the hand was seen open.

#include <vector>

#include "input/gestures/closing_fingers.h"
#include "input/gestures/gesture_event.h"
#include "input/gestures/gesture_options.h"
#include "input/hand_frame.h"

namespace dubsar {

class GripDetector {
 public:
  struct Moment {
    TimestampNs now = 0, since_ns = 0;  ///< since the sample before
    double speed_mps = 0.0;             ///< of the palm
    TimestampNs still_ns = 0;           ///< for how long the hand has been held still
    bool closing = false;               ///< its fingers move, and drag the palm along
    bool may_begin = true;
    bool sure_person = true;  ///< false: it may be somebody else's, who reaches in
    bool beginner = false;    ///< who has not turned anything yet
    bool rests(const GestureOptions& options) const noexcept {
      return speed_mps <= options.grab.rest_mps ||
             (closing && sure_person && options.grab.still_ns > 0 && still_ns >= options.grab.still_ns &&
              speed_mps <= ClosingFingers::kPalmMps);
    }
  };
  /// What began and ended is added to `events`. One thread.
  void update(const Moment& moment, const HandFrame& hand, const GestureOptions& options,
              std::vector<GestureEvent>& events);
  /// The hand is gone: what it held is cancelled.
  void lose(TimestampNs now, std::vector<GestureEvent>& events);

  bool grabbing() const noexcept { return grabbing_; }
  bool pinching() const noexcept { return pinching_; }
  bool holds() const noexcept { return grabbing_ || pinching_; }
  bool may_grab() const noexcept { return grab_armed_; }  ///< it was seen open, so that closing it takes hold

 private:
  void grab(const Moment& moment, const HandFrame& hand, const GestureOptions& options,
            std::vector<GestureEvent>& events);
  enum class Closing { kOpen, kOnItsWay, kPerhaps, kSure };
  static Closing judge(const Moment& moment, const GestureOptions& options, bool closed, TimestampNs& since);
  void pinch(const Moment& moment, const HandFrame& hand, const GestureOptions& options,
             std::vector<GestureEvent>& events);

  bool grabbing_ = false, pinching_ = false;
  bool grab_armed_ = false, pinch_armed_ = false;       // the hand was seen open
  double open_grab_ = 1.0, closest_grab_ = 0.0;         // how open it was lately; how closed in this grab
  TimestampNs closed_since_ = -1, pinched_since_ = -1;  // of a hold that is not sure yet
  TimestampNs opened_since_ = -1;                       // of a grab that may be over
};

}  // namespace dubsar
