#pragma once
// What stands behind everything that a session shows: the dark ground of its window, its slices and its borders.

#include "display/render/shading.h"

namespace dubsar::app {

inline constexpr Rgb8 kGroundColor{0x17, 0x18, 0x1b};

}  // namespace dubsar::app
