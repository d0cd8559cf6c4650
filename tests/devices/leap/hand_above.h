#pragma once
// A hand at rest a quarter of a metre above a controller.

#include "devices/leap/hand_model.h"

namespace dubsar {

/// `x_m` to the right of the middle, leap frame.
inline PosedHand hand_above(double x_m = 0.0) {
  HandPose pose;
  pose.palm.position_m = {x_m, 0.25, 0.0};
  return pose_hand(pose);
}

}  // namespace dubsar
