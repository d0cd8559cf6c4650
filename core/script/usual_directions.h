#pragma once
// The directions in which a tablet's own wedges point, so that those which fit as well turned are turned as the others
// are. What is known beforehand is where kinds of wedges point, not how many there are of each.

#include <numbers>
#include <span>
#include <vector>

#include "core/script/explain_relief.h"
#include "core/script/text_sides.h"

namespace dubsar {

/// Density over the angle to the line of text, of wedges with a tail and of short ones; mean 1.
class UsualDirections {
 public:
  /// Of none: all directions alike.
  UsualDirections() = default;
  UsualDirections(std::span<const PlacedImprint> placed, const TextSides& sides);

  /// -log of the density; and how much less likely a short one is than turned by a third, by the vote of all that fit
  /// nearly as well turned.
  double surprise(double angle, bool long_one) const;

 private:
  static constexpr int kSectors = 72;
  void vote(std::span<const PlacedImprint> placed, const TextSides& sides);
  std::vector<double> long_, short_;
  std::vector<double> thirds_;  ///< log likelihood of short ones that point there, of the votes alone
};

/// A tail that reaches farther than this, in widths from T, is one; a Winkelhaken ends before.
bool is_long(const Imprint& imprint);

/// Turns the text of each side but the obverse to where its wedges point as those of the whole tablet do, if that is
/// clearly more likely than what is usual.
void turn_sides(TextSides& sides, std::span<const PlacedImprint> placed);

}  // namespace dubsar
