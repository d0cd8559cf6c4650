#pragma once
// One hand's gestures: grab, pinch, swipe and dwell. A hand that is lost cancels, it never releases; nothing begins
// right after a hand came in.

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "input/gestures/closing_fingers.h"
#include "input/gestures/dwell_detector.h"
#include "input/gestures/gesture_event.h"
#include "input/gestures/gesture_options.h"
#include "input/gestures/grip_detector.h"
#include "input/gestures/stillness.h"
#include "input/gestures/swipe_detector.h"
#include "input/hand_frame.h"
#include "input/hand_standing.h"
#include "input/people/one_euro.h"
#include "input/people/pose_history.h"

namespace dubsar {

class GestureRecognizer {
 public:
  explicit GestureRecognizer(const GestureOptions& options = {});

  /// The hand at `now`, or null when no hand is seen in this slot. A hand with `tracked` false, or whose time does not
  /// advance, counts as missing. A hand at its person's face does nothing but dwell. What happened is in events(),
  /// until the next call. One thread.
  void update(TimestampNs now, const HandFrame* hand, const HandStanding& standing = {});

  /// Holds from the next update() on.
  void set_scene(const GestureScene& scene) noexcept { scene_ = scene; }

  const std::vector<GestureEvent>& events() const noexcept { return events_; }
  bool present() const noexcept { return seen_.came.has_value(); }  ///< seen at most hold_ns ago
  bool seen_now() const noexcept { return seen_.now; }              ///< measured since the update before
  bool grabbing() const noexcept { return grip_.grabbing(); }
  bool pinching() const noexcept { return grip_.pinching(); }
  bool may_grab() const noexcept { return grip_.may_grab(); }  ///< it was seen open, so that closing it takes hold
  bool fingers_close() const noexcept { return closing_; }     ///< and drag the palm along
  const glm::dvec3& position_m() const noexcept { return position_m_; }  ///< of the palm, filtered; stays while held
  const glm::dvec3& velocity_mps() const noexcept { return velocity_mps_; }
  double dwell_progress() const noexcept { return dwell_.progress(); }  ///< 0..1

 private:
  void lose(TimestampNs now);

  struct Sight {
    std::optional<TimestampNs> came;
    TimestampNs last = 0, sample = -1;
    bool now = false;
    std::uint32_t id = 0;
  };

  GestureOptions options_;
  OneEuroVector filter_;
  PositionHistory history_;
  GripDetector grip_;
  SwipeDetector swipe_;
  DwellDetector dwell_;
  ClosingFingers fingers_;
  Stillness stillness_;
  std::vector<GestureEvent> events_;
  Sight seen_{};
  bool closing_ = false;
  GestureScene scene_;
  glm::dvec3 position_m_{0.0}, velocity_mps_{0.0}, cursor_m_{0.0};
};

}  // namespace dubsar
