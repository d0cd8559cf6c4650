#pragma once
// Slices of the scan beside the surface: pictures with the surface's outline, a place that all of them go through, and
// what the mouse does in them. Like all panels it changes nothing: it posts commands.

#include <array>

#include "app/slices/slice_state.h"

namespace dubsar::app {

/// Where the pictures of kSliceNames stand in the layout; `large` as of ScanView.
std::array<PanelRect, kSlices> slice_rects(float width, float height, int large) noexcept;

}  // namespace dubsar::app
