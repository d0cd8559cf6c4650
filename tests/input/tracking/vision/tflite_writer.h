#pragma once
// Writes graphs as TensorFlow Lite files, for tests of the reader.

#include <cstddef>
#include <vector>

#include "input/tracking/vision/net_graph.h"

namespace dubsar {

/// `halves`: weights go into 16-bit floats and are widened by an operation each; give values that 16 bits can
/// hold.
std::vector<std::byte> write_tflite(const NetGraph& graph, bool halves);

/// A net of all operations with small whole numbers as weights: 1 x 7 x 6 x 3 in; a row, a table and a
/// probability out.
NetGraph tiny_net();

/// What the graph gives for a picture (rows x columns x channels), by plain loops after the definitions of
/// the operations.
std::vector<std::vector<float>> run_by_hand(const NetGraph& graph, const std::vector<float>& picture);

}  // namespace dubsar
