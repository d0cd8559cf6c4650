#pragma once
// Two views in alternate rows, columns, squares or subpixels, for polarised, shutter-row and barrier panels. Which eye
// a pixel belongs to follows from its place on the panel, not in the window.

#include "core/image_io/image.h"
#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

enum class InterlacePattern : int { kRows = 0, kColumns = 1, kCheckerboard = 2, kSubpixels = 3 };

/// Whether counting rows from the panel's bottom exchanges the eyes: on panels with an even number of rows.
bool bottom_exchanges(InterlacePattern pattern, int panel_height) noexcept;

/// Options: rows (default), columns, checkerboard or subpixels; left_first (default) or right_first, the eye of the
/// first row or square; for rows and checkerboard top (default: the panel's upper left corner is first, as ffmpeg's
/// stereo3d has it) or bottom (its lower left corner, as Bino has it).
Result<std::unique_ptr<OutputSink>> make_interlaced_sink(SinkOptions options);

}  // namespace dubsar
