#pragma once
// Two views one after the other, each over the whole window, for shutter glasses in step with the monitor: projectors
// with DLP Link, televisions and glasses of 100 Hz and more.

#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// Options: left_first (default) or right_first, for glasses that open the other eye at the beat we call the first.
/// Field::kFirst is the left eye's picture, or the right one's.
Result<std::unique_ptr<OutputSink>> make_shutter_sink(SinkOptions options);

}  // namespace dubsar
