#pragma once
// Two eyes through one window.

#include <array>

#include "display/optics/off_axis.h"

namespace dubsar {

/// Left and right view through the window; the other way round where viewer.swap_eyes says so.
std::array<View, 2> stereo_views(const Screen& screen, const Observer& viewer);

}  // namespace dubsar
