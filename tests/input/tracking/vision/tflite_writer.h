#pragma once
// Writes graphs as TensorFlow Lite files, for tests of the reader.

#include <cstddef>
#include <vector>

#include "input/tracking/vision/net_graph.h"

namespace dubsar {

/// `halves`: weights go into 16-bit floats and are widened by an operation each; give values that 16 bits can
/// hold.
std::vector<std::byte> write_tflite(const NetGraph& graph, bool halves);

}  // namespace dubsar
