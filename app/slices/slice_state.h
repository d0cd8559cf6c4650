#pragma once
// What is shown of the slices of a scan, as values between who reads them and who draws them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "app/slices/slice_reader.h"

namespace dubsar::app {

/// A slice's picture in graphics memory, and what it shall show.
struct SlicePane {
  SliceFrame wanted{};
  SharedSlice picture{};  ///< null: nothing yet; of an earlier place while its frame is another one
  std::uint32_t texture = 0;
  std::uint64_t shade = 0;  ///< counts how often the texture was made
  bool ready() const { return picture && picture->frame == wanted && picture->exact; }
  friend bool operator==(const SlicePane&, const SlicePane&) = default;
};

struct SlicePanelState {
  std::array<SlicePane, kSlices> panes{};
  std::string note{};            ///< what is to be known of the scan
  double black = 0, white = 1;   ///< values that are shown so
  std::optional<float> value{};  ///< of the scan, at the place that all slices go through
  bool scan = false;
  friend bool operator==(const SlicePanelState&, const SlicePanelState&) = default;
};

struct PanelRect {
  float x = 0, y = 0, width = 0, height = 0;
  bool shown() const noexcept { return width >= 8 && height >= 8; }
};

/// What the slices take of a layout of this width; the surface has the rest.
inline float slices_width(float width) noexcept { return std::max(280.0f, 0.44f * width); }

}  // namespace dubsar::app
