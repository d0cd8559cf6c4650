#pragma once
// A small convolutional network as plain data: what a model file says, checked, before anything runs it.

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

/// Pictures are 1 x rows x columns x channels, as in the file; the first dimension of everything is 1.
struct NetTensor {
  std::vector<int> shape;
  bool constant = false;
  std::vector<float> numbers;          ///< of constants: weights
  std::vector<std::int32_t> integers;  ///< of constants: paddings, axes, sizes

  std::int64_t count() const noexcept {
    std::int64_t n = 1;
    for (const int size : shape) n *= size;
    return n;
  }
};

enum class NetOpKind : std::uint8_t {
  kConv,           ///< picture, weights (out, rows, columns, in), bias
  kDepthwiseConv,  ///< picture, weights (1, rows, columns, out), bias
  kAdd,
  kPrelu,  ///< picture, one slope for each channel
  kRelu,
  kRelu6,
  kPad,  ///< picture, (before, after) for each of its dimensions
  kMaxPool,
  kResizeBilinear,
  kReshape,
  kConcat,
  kMean,            ///< over rows and columns
  kFullyConnected,  ///< row, weights (out, in), bias
  kLogistic,
};

enum class NetActivation : std::uint8_t { kNone, kRelu, kRelu6 };

struct NetOp {
  NetOpKind kind = NetOpKind::kAdd;
  std::vector<int> inputs;  ///< tensors
  int output = 0;
  bool same_padding = true;  ///< output size is input size / stride, rounded up; the odd pixel of padding comes last
  int stride_rows = 1, stride_columns = 1;
  int filter_rows = 1, filter_columns = 1;
  int axis = 0;
  NetActivation activation = NetActivation::kNone;
  bool align_corners = false, half_pixel_centres = false;
};

struct NetGraph {
  std::vector<NetTensor> tensors;
  std::vector<NetOp> ops;  ///< in the order in which they can run
  int input = 0;
  std::vector<int> outputs;
};

/// Padding before and after along one dimension for "same" padding.
struct NetPadding {
  int before = 0, after = 0;
};
NetPadding same_padding(int size, int filter, int stride) noexcept;

/// kBadData, with the operation's number, unless every operation reads tensors that are there by then, its
/// operands have the shapes that it needs and its output has the shape that follows from them. What passes
/// can be run without surprises. `source` starts the error text.
Result<void> check_graph(const NetGraph& graph, std::string_view source);

}  // namespace dubsar
