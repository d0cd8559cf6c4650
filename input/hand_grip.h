#pragma once
// A hand of who wears a headset, as something that closes round things.

#include <array>

#include "core/base/numbers/pose.h"

namespace dubsar {

struct HandGrip {
  bool active = false;      ///< seen
  bool closed = false;      ///< squeezed, pinched or a fist
  bool controller = false;  ///< one is in it; else it is bare
  Pose pose{};              ///< screen frame, metres
  bool operator==(const HandGrip& other) const {
    return active == other.active && closed == other.closed && controller == other.controller &&
           pose.position_m == other.pose.position_m && pose.rotation == other.pose.rotation;
  }
};

/// [0] left, [1] right.
using HandGrips = std::array<HandGrip, 2>;

}  // namespace dubsar
