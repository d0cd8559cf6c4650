#pragma once
// One hand's gestures: grab, pinch, swipe and dwell, each with its hysteresis. A hand that is lost cancels, it never
// releases; grabbing masks pinching; nothing begins right after a hand came in, nor before it was seen open.

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "input/gestures/gesture_options.h"
#include "input/hand_frame.h"
#include "input/people/one_euro.h"
#include "input/people/pose_history.h"

namespace dubsar {

enum class GestureKind { kGrab, kPinch, kSwipe, kDwell };
enum class GesturePhase {
  kBegin,
  kEnd,     ///< let go on purpose
  kCancel,  ///< the hand was lost, or a stronger gesture took over
  kDone,    ///< swipe and dwell: it happened
};
enum class SwipeDirection { kLeft, kRight, kUp, kDown };

struct GestureEvent {
  TimestampNs time = 0;
  GestureKind kind{};
  GesturePhase phase{};
  SwipeDirection direction{};  ///< of a swipe
};

class GestureRecognizer {
 public:
  explicit GestureRecognizer(const GestureOptions& options = {});

  /// The hand at `now`, or null when no hand is seen in this slot. A hand with `tracked` false, or whose time does not
  /// advance, counts as missing. What happened is in events(), until the next call. One thread.
  void update(TimestampNs now, const HandFrame* hand);

  const std::vector<GestureEvent>& events() const noexcept { return events_; }
  bool present() const noexcept { return came_.has_value(); }  ///< seen at most hold_ns ago
  bool seen_now() const noexcept { return seen_now_; }         ///< measured since the update before
  bool grabbing() const noexcept { return grabbing_; }
  bool pinching() const noexcept { return pinching_; }
  bool may_grab() const noexcept { return grab_armed_; }  ///< it was seen open, so that closing it takes hold
  const glm::dvec3& position_m() const noexcept { return position_m_; }  ///< of the palm, filtered; stays while held
  const glm::dvec3& velocity_mps() const noexcept { return velocity_mps_; }
  double dwell_progress() const noexcept { return dwell_progress_; }  ///< 0..1
  /// Where the dwelling hand points, metres in the screen frame.
  const glm::dvec3& cursor_m() const noexcept { return cursor_m_; }

 private:
  void lose(TimestampNs now);
  void grab_and_pinch(TimestampNs now, const HandFrame& hand, TimestampNs since_ns);
  void swipe(TimestampNs now);
  void dwell(TimestampNs now);
  void add(TimestampNs now, GestureKind kind, GesturePhase phase, SwipeDirection direction = {});

  GestureOptions options_;
  OneEuroVector filter_;
  PositionHistory history_;
  std::vector<GestureEvent> events_;
  std::optional<TimestampNs> came_, swiped_, dwell_since_;
  TimestampNs last_seen_ = 0, last_sample_ = -1, slow_since_ = 0;
  bool seen_now_ = false, grabbing_ = false, pinching_ = false;
  bool grab_armed_ = false, pinch_armed_ = false;  // the hand was seen open
  double open_grab_ = 1.0, closest_grab_ = 0.0;    // how open it was lately; how closed in this grab
  bool dwelt_ = false;                             // once per rest
  bool swipe_ended_ = true, swipe_rested_ = true;
  int swipe_axis_ = 0;
  double swipe_sign_ = 0.0, dwell_progress_ = 0.0;
  std::optional<glm::dvec3> swipe_from_m_;
  glm::dvec3 position_m_{0.0}, velocity_mps_{0.0}, cursor_m_{0.0}, dwell_at_m_{0.0};
};

}  // namespace dubsar
