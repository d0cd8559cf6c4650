#pragma once
// Flashes in a row of pictures, as those who are sensitive to light count them.

#include <cstddef>
#include <deque>
#include <vector>

#include "core/image_io/image.h"

namespace dubsar::app::test {

/// A flash is a pair of opposing changes of relative luminance by 10 % of the most a screen can show, where the darker
/// of the two is below 80 % of it (WCAG 2.2, "general flash threshold"). Counted for every block of 8 x 8 pixels.
class Flashes {
 public:
  /// The next picture, RGB, all of one size; rising times, seconds.
  void add(double time_s, const Image& picture);
  /// The most flashes that any block had within a second, so far.
  int most_in_a_block() const noexcept { return most_in_a_block_; }
  /// The most flashes within a second that a quarter of all blocks had: more than 3 are dangerous.
  int most_in_a_quarter() const noexcept { return most_in_a_quarter_; }

 private:
  struct Block {
    double turn = -1.0;            ///< the last extreme, or the running one
    int way = 0;                   ///< 1: it became brighter last, -1: darker
    std::deque<double> changes_s;  ///< of the last second
  };
  std::vector<Block> blocks_;
  int most_in_a_block_ = 0, most_in_a_quarter_ = 0;
};

}  // namespace dubsar::app::test
