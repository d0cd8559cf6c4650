#pragma once
// Fingers on a touch panel as events of a pointer: one finger is a mouse's left button, several are a pinch. Pure
// arithmetic; the window that knows where it is on the panel places the fingers.

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/base/system/clock.h"
#include "input/input_event.h"

namespace dubsar {

/// A finger where it is on the window.
struct PlacedTouch {
  std::uint32_t id = 0;
  glm::dvec2 at{0.0};  ///< heights of the window from its middle, to the right and up
  bool inside = true;  ///< on the window; one that came beside it does not count until it is lifted
};

/// One finger takes hold when it moves or has rested for 150 ms, where it came down; lifted before that it is a click.
/// From the second finger on nothing is clicked: what was held is let go of, and all steps of the fingers are those of
/// the similarity that fits them best (of two exactly), between reports by those fingers that are in both, so that a
/// finger that comes or goes moves nothing. One that stays behind takes hold anew where it is, when it has moved.
/// One thread.
class TouchPointer {
 public:
  /// All fingers at `time`, which never falls. `cancelled`: those that are missing were not lifted, and click nothing.
  void update(TimestampNs time, std::span<const PlacedTouch> fingers, bool cancelled, std::vector<InputEvent>& out);
  /// Nothing was heard of the panel up to `now`.
  void advance(TimestampNs now, std::vector<InputEvent>& out);

 private:
  enum class Phase {
    kNone,
    kRests,  ///< one finger, which may become a click
    kHolds,  ///< its button is down
    kPinches,
    kStays,  ///< one of several stayed behind
  };
  void press(TimestampNs time, const glm::dvec2& at, std::vector<InputEvent>& out);
  void release(TimestampNs time, std::optional<glm::dvec2> at, std::vector<InputEvent>& out);
  void move(TimestampNs time, const glm::dvec2& to, std::vector<InputEvent>& out);
  void pinch(TimestampNs time, std::span<const PlacedTouch> fingers, std::vector<InputEvent>& out);
  void none(TimestampNs time, bool cancelled, std::vector<InputEvent>& out);
  void one(TimestampNs time, const PlacedTouch& finger, bool cancelled, std::vector<InputEvent>& out);

  Phase phase_ = Phase::kNone;
  std::vector<PlacedTouch> fingers_;   // of the last report, those that count
  std::vector<std::uint32_t> beside_;  // that came beside the window and are still there
  TimestampNs since_ = 0;              // of kRests
  glm::dvec2 from_{0.0}, at_{0.0};     // of one finger: where it came down or stayed; where it is
};

/// The similarity of the plane that takes `before` to `after`, in the sense of least squares: its step about the middle
/// of `before`. Points that lie together tell no factor and no roll.
PinchStep pinch_between(std::span<const glm::dvec2> before, std::span<const glm::dvec2> after);

}  // namespace dubsar
