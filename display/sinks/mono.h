#pragma once
// One view, from the middle between the eyes; and the sink that draws nothing.

#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

Result<std::unique_ptr<OutputSink>> make_mono_sink(SinkOptions options);

/// Asks for the views of a mono sink and drops them: measures everything before compose().
Result<std::unique_ptr<OutputSink>> make_null_sink(SinkOptions options);

}  // namespace dubsar
