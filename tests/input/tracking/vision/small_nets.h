#pragma once
// A net whose answers can be had by plain loops, for tests of what runs networks.

#include <vector>

#include "input/tracking/vision/net_graph.h"

namespace dubsar {

/// A net of all operations with small whole numbers as weights: 1 x 7 x 6 x 3 in; a row, a table and a
/// probability out.
NetGraph tiny_net();

/// What the graph gives for a picture (rows x columns x channels), by plain loops after the definitions of
/// the operations.
std::vector<std::vector<float>> run_by_hand(const NetGraph& graph, const std::vector<float>& picture);

}  // namespace dubsar
