#pragma once
// Panels with a lens sheet: N views (Looking Glass and generic sheets), or two views woven for tracked eyes. The maths
// and the CPU references are in display/optics/lens.h and display/optics/weave.h.

#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// Options: PROFILE or panel=PROFILE (a panel's name), calibration=FILE (a Looking Glass unit's visual.json; names the
/// model too, unless PROFILE does). Of many views: nearest, linear (default), gaussian3 or gaussian10, focus=, zoom=;
/// of two tracked ones: left_first, right_first. The window counts when the screen has the panel's pixels, else the
/// picture is that of the whole panel.
Result<std::unique_ptr<OutputSink>> make_lenticular_sink(SinkOptions options);

}  // namespace dubsar
