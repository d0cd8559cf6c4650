#pragma once
// Slices of the scan beside the surface: pictures with the surface's outline, a place that all of them go through, and
// what the mouse does in them. Like all panels it changes nothing: it posts commands.

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
float slices_width(float width) noexcept;
/// Where the pictures of kSliceNames stand in the layout; `large` as of ScanView.
std::array<PanelRect, kSlices> slice_rects(float width, float height, int large) noexcept;

struct Board;
void draw_slices(const Board& desk);

}  // namespace dubsar::app
