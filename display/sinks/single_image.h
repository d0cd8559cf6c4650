#pragma once
// One view into picture files.

#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// Options: path=FILE.png; a % in it is replaced by the number of the frame, five digits. Without % every frame
/// replaces the file. Writes what compose() draws as PNG, and draws it to the surface too.
Result<std::unique_ptr<OutputSink>> make_image_sink(SinkOptions options);

}  // namespace dubsar
