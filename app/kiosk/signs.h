#pragma once
// Big signs beside the object that are chosen by resting a hand's ring on them.

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/base/system/clock.h"

namespace dubsar::app {

enum class Sign : std::uint8_t { kOpen, kClose, kTour, kNext, kLeave };
inline constexpr std::size_t kSignCount = 5;

/// Places are shares of the panel's width and height, from its middle, to the right and up; the radius is a share of
/// its height.
struct SignPicture {
  Sign sign{};
  glm::dvec2 at{0.0};
  double radius = 0.09;
  double filled = 0.0;  ///< 0..1: how much of the rest is over
  friend bool operator==(const SignPicture&, const SignPicture&) = default;
};

/// The places of some signs on a panel that is `aspect` times as wide as high: a column at the upper right, where hands
/// that play with the object rarely rest.
std::vector<SignPicture> place_signs(std::span<const Sign> signs, double aspect);

/// The same signs on a panel of another shape, as full as they are.
std::vector<SignPicture> signs_on(std::span<const SignPicture> signs, double aspect);

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
