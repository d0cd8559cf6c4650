#pragma once
// Big signs beside the object that are chosen by resting a hand's ring on them.

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "app/document/gallery_picture.h"
#include "core/base/system/clock.h"

namespace dubsar::app {

/// The sign at a place, such as a finger's on the glass; none: there is none.
std::optional<Sign> sign_at(const glm::dvec2& at, std::span<const SignPicture> signs, double aspect);

/// A hand's ring, placed as signs are.
struct SignHand {
  glm::dvec2 at{0.0};
  bool free = true;  ///< false: it holds the object, or must open first: where that ends chooses nothing
};

/// How long which sign was rested on. One thread.
class SignRest {
 public:
  /// The sign that is chosen now. Afterwards, and when a hand that is not free came to a sign, none is chosen until all
  /// hands were seen beside the column of signs, or were gone for a while: a tired hand sinks from one sign to the
  /// next.
  std::optional<Sign> update(TimestampNs now, std::span<const SignHand> hands, std::span<const SignPicture> signs,
                             double aspect);
  double filled(Sign sign) const noexcept;

 private:
  struct Rest {
    TimestampNs since = -1, seen = 0;
    double filled = 0.0;
  };
  std::array<Rest, kSignCount> rests_{};
  bool waits_ = false;  // until the hands have left the signs
  TimestampNs hands_seen_ = 0;
};

}  // namespace dubsar::app
