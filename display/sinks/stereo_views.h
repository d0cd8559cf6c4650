#pragma once
// Two eyes through one window.

#include <array>

#include "display/optics/off_axis.h"

namespace dubsar {

/// Left and right view through the window.
std::array<View, 2> stereo_views(const Screen& screen, const Viewer& viewer);

}  // namespace dubsar
