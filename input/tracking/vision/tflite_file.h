#pragma once
// TensorFlow Lite model files (.tflite), as far as palm, hand and face networks need them.

#include <cstddef>
#include <span>
#include <string_view>

#include "input/tracking/vision/net_graph.h"

namespace dubsar {

/// Reads a model with one picture as its input: weights in 32- or 16-bit floating point (16-bit ones are
/// widened), the operations of NetOpKind, no dilation. The bytes are not trusted: every offset is checked,
/// and the graph by check_graph(). kBadData says what was found. Schema: tensorflow/lite/schema/schema.fbs,
/// version 3. One thread, a few milliseconds.
Result<NetGraph> read_tflite(std::span<const std::byte> bytes, std::string_view source);

}  // namespace dubsar
