#pragma once
// Two views into the left and the right buffer of one window: shutter glasses, zSpace, polarised projectors, on drivers
// with stereo visuals.

#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// No options of its own. compose() wants a surface with eye_buffers: kUnavailable without.
Result<std::unique_ptr<OutputSink>> make_quad_buffer_sink(SinkOptions options);

}  // namespace dubsar
