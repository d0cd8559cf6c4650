#pragma once
// Two views in one picture: side by side, or one above the other. Half: each view is squeezed to half the window, and
// the display stretches it. Full: the picture is twice the window. Frame packing (HDMI 1.4): full, left above, with a
// black gap of 1/24 of a view's height (30 lines at 720, 45 at 1080).

#include "core/image_io/image.h"
#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

struct Packing {
  bool vertical = false;  ///< top and bottom instead of side by side
  bool full = false;
  bool frame_packing = false;
  bool right_first = false;  ///< the right eye's view is at the left, or on top

  PixelSize view_size(PixelSize window) const noexcept;
  PixelSize output_size(PixelSize window) const noexcept;
  /// Upper left corner of a view (0 left eye, 1 right eye) in the output.
  PixelSize place(PixelSize window, int eye) const noexcept;
};

Result<std::unique_ptr<OutputSink>> make_side_by_side_sink(SinkOptions options);
Result<std::unique_ptr<OutputSink>> make_top_bottom_sink(SinkOptions options);

}  // namespace dubsar
