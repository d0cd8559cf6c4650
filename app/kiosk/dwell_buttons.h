#pragma once
// Big buttons beside the object that are chosen by resting a hand's ring on them.

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "app/document/gallery_picture.h"
#include "core/base/system/clock.h"

namespace dubsar::app {

/// The button at a place, such as a finger's on the glass; none: there is none.
std::optional<DwellButton> button_at(const glm::dvec2& at, std::span<const DwellButtonPicture> buttons, double aspect);

/// A hand's ring, placed as buttons are.
struct DwellHand {
  glm::dvec2 at{0.0};
  bool free = true;  ///< false: it holds the object, or must open first: where that ends chooses nothing
};

/// How long which button was rested on. One thread.
class DwellTimer {
 public:
  /// The button that is chosen now. Afterwards, and when a hand that is not free came to a button, none is chosen until
  /// all hands were seen beside the column of buttons, or were gone for a while: a tired hand sinks from one button to
  /// the next.
  std::optional<DwellButton> update(TimestampNs now, std::span<const DwellHand> hands,
                                    std::span<const DwellButtonPicture> buttons, double aspect);
  double filled(DwellButton button) const noexcept;

 private:
  struct Rest {
    TimestampNs since = -1, seen = 0;
    double filled = 0.0;
  };
  std::array<Rest, kDwellButtonCount> rests_{};
  bool waits_ = false;  // until the hands have left the buttons
  TimestampNs hands_seen_ = 0;
};

}  // namespace dubsar::app
