#pragma once
// Which way up to start the fit of a hand: left or right, open or closed, turned how; and what is remembered
// of it.

#include <optional>
#include <span>
#include <vector>

#include "input/tracking/hands/hand_fit.h"

namespace dubsar {

/// What outline and correlation say about a hand, in the device's frame.
struct HandGuess {
  glm::dvec3 palm_m{};
  double depth_m = 0.0;
  double radius_m = 0.0;           ///< of the largest circle in the palm
  double turn_rad = 0.0;           ///< about +Y, 0: fingers to -Z
  double grab = 0.0;               ///< 0: open hand, 1: fist
  double pixel_m = 0.0;            ///< size of a pixel at that depth
  std::vector<double> finger_rad;  ///< directions of fingers that stick out, from the hand's, rising, positive about +Y
};

/// What is known of one hand from the frames before.
struct HandMemory {
  int right_votes = 0;  ///< positive: right hand
  int frames = 0;       ///< that the three means below are made of
  double scale = 1.0, finger_length = 1.0, palm_width = 1.0;
  struct Last {
    HandPose pose{};
    glm::dvec3 guess_m{};
  };
  std::optional<Last> last;  ///< where the next fit starts
};

struct FoundHand {
  HandPose pose{};
  double misfit = 0.0;  ///< RMS difference of skin share per sample beyond the noise
  bool fits = false;    ///< a hand explains both pictures; otherwise `pose` is no more than the guess
};

/// Tries starts until one fits: where the hand was, then left and right as guessed, then turned, shifted, opened or
/// closed. `memory` is brought up to date. About 1 ms if the first start fits, at most about 6.
FoundHand search_hand(HandFit& fit, std::span<const EyeSamples> eyes, const HandGuess& guess, HandMemory& memory);

}  // namespace dubsar
