#include "input/tracking/vision/net_graph.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace dubsar {
namespace {

constexpr std::int64_t kMostElements = std::int64_t{1} << 24;  // of one tensor: 64 MiB
constexpr std::int64_t kMostWork = 10'000'000'000;             // multiplications; palms and hands take less than 1
constexpr int kLargestSize = 1 << 14;
constexpr int kLargestFilter = 64;

class GraphCheck {
 public:
  GraphCheck(const NetGraph& graph, std::string_view source)
      : graph_(graph), source_(source), known_(graph.tensors.size()) {}

  Result<void> run() {
    for (std::size_t i = 0; i < graph_.tensors.size(); ++i) {
      DUBSAR_TRY(check_shape(i));
      known_[i] = graph_.tensors[i].constant;
    }
    if (!exists(graph_.input) || graph_.tensors[index(graph_.input)].constant ||
        graph_.tensors[index(graph_.input)].shape.size() != 4)
      return fail(ErrorKind::kBadData, "{}: the input is not a picture", source_);
    known_[index(graph_.input)] = true;
    for (std::size_t i = 0; i < graph_.ops.size(); ++i)
      if (const char* const wrong = check_op(graph_.ops[i]))
        return fail(ErrorKind::kBadData, "{}: operation {} of {}: {}", source_, i, graph_.ops.size(), wrong);
    if (graph_.outputs.empty()) return fail(ErrorKind::kBadData, "{}: no outputs", source_);
    for (const int output : graph_.outputs)
      if (!exists(output) || !known_[index(output)] || graph_.tensors[index(output)].constant || output == graph_.input)
        return fail(ErrorKind::kBadData, "{}: output {} is made by no operation", source_, output);
    return {};
  }

 private:
  static std::size_t index(int tensor) noexcept { return static_cast<std::size_t>(tensor); }
  bool exists(int tensor) const noexcept { return tensor >= 0 && index(tensor) < graph_.tensors.size(); }

  Result<void> check_shape(std::size_t i) const {
    const NetTensor& tensor = graph_.tensors[i];
    std::int64_t count = 1;
    for (const int size : tensor.shape) {
      if (size < 1 || size > kLargestSize || count * size > kMostElements)
        return fail(ErrorKind::kBadData,
                    "{}: tensor {} has a size of {}, expected 1 to {} and 16 million elements at most", source_, i,
                    size, kLargestSize);
      count *= size;
    }
    if (tensor.constant && static_cast<std::int64_t>(tensor.numbers.size() + tensor.integers.size()) != count)
      return fail(ErrorKind::kBadData, "{}: tensor {} has {} values, expected {}", source_, i,
                  tensor.numbers.size() + tensor.integers.size(), count);
    return {};
  }

  /// What is wrong with it, or null.
  const char* check_op(const NetOp& op) {
    for (const int input : op.inputs)
      if (!exists(input) || !known_[index(input)]) return "it reads what is not there yet";
    if (!exists(op.output) || known_[index(op.output)]) return "its output was made before";
    known_[index(op.output)] = true;
    if (op.stride_rows < 1 || op.stride_rows > kLargestFilter || op.stride_columns < 1 ||
        op.stride_columns > kLargestFilter || op.filter_rows < 1 || op.filter_rows > kLargestFilter ||
        op.filter_columns < 1 || op.filter_columns > kLargestFilter)
      return "stride or filter size out of range";
    const auto operands = [&](std::size_t data, std::size_t constants) {
      if (op.inputs.size() != data + constants) return false;
      for (std::size_t i = 0; i < op.inputs.size(); ++i)
        if (graph_.tensors[index(op.inputs[i])].constant != (i >= data)) return false;
      return true;
    };
    const char* const wrong_operands = "operands missing, too many, or constant where data was expected";
    switch (op.kind) {
      case NetOpKind::kConv:
      case NetOpKind::kDepthwiseConv:
        return operands(1, 2) ? check_conv(op) : wrong_operands;
      case NetOpKind::kAdd:
        return operands(2, 0) ? same_shapes(op, {0, 1}) : wrong_operands;
      case NetOpKind::kPrelu:
        return operands(1, 1) ? check_prelu(op) : wrong_operands;
      case NetOpKind::kRelu:
      case NetOpKind::kRelu6:
      case NetOpKind::kLogistic:
        return operands(1, 0) ? same_shapes(op, {0, 0}) : wrong_operands;
      case NetOpKind::kPad:
        return operands(1, 1) ? check_pad(op) : wrong_operands;
      case NetOpKind::kMaxPool:
        return operands(1, 0) ? check_pool(op) : wrong_operands;
      case NetOpKind::kResizeBilinear:
        return operands(1, 1) ? check_resize(op) : wrong_operands;
      case NetOpKind::kReshape:
        return operands(1, 0) || operands(1, 1) ? check_reshape(op) : wrong_operands;
      case NetOpKind::kConcat:
        return op.inputs.size() > 1 && operands(op.inputs.size(), 0) ? check_concat(op) : wrong_operands;
      case NetOpKind::kMean:
        return operands(1, 1) ? check_mean(op) : wrong_operands;
      case NetOpKind::kFullyConnected:
        return operands(1, 2) ? check_fully_connected(op) : wrong_operands;
    }
    return "unknown kind";
  }

  const NetTensor& input(const NetOp& op, std::size_t i) const { return graph_.tensors[index(op.inputs[i])]; }
  const NetTensor& output(const NetOp& op) const { return graph_.tensors[index(op.output)]; }
  static bool picture(const NetTensor& tensor) { return tensor.shape.size() == 4 && tensor.shape[0] == 1; }
  static int strided(int size, int filter, int stride, bool same) {
    if (same) return (size + stride - 1) / stride;
    return size < filter ? 0 : (size - filter) / stride + 1;
  }

  const char* same_shapes(const NetOp& op, std::array<std::size_t, 2> which) const {
    const bool same = input(op, which[0]).shape == output(op).shape && input(op, which[1]).shape == output(op).shape;
    return same ? nullptr : "operands and output differ in shape";
  }

  const char* check_window(const NetOp& op, int filter_rows, int filter_columns, int channels) const {
    const NetTensor &in = input(op, 0), &out = output(op);
    if (!picture(in) || !picture(out)) return "not a picture";
    if (out.shape[1] != strided(in.shape[1], filter_rows, op.stride_rows, op.same_padding) ||
        out.shape[2] != strided(in.shape[2], filter_columns, op.stride_columns, op.same_padding) ||
        out.shape[3] != channels)
      return "the output has the wrong size";
    return nullptr;
  }
  const char* check_conv(const NetOp& op) {
    const NetTensor &in = input(op, 0), &weights = input(op, 1), &bias = input(op, 2);
    if (!picture(in) || weights.shape.size() != 4 || weights.numbers.empty() || bias.numbers.empty())
      return "no picture, or no weights of four dimensions";
    const bool depthwise = op.kind == NetOpKind::kDepthwiseConv;
    const int channels = weights.shape[depthwise ? 3 : 0];
    if (depthwise ? weights.shape[0] != 1 || channels % in.shape[3] != 0 : weights.shape[3] != in.shape[3])
      return "weights do not fit the channels";
    if (weights.shape[1] > kLargestFilter || weights.shape[2] > kLargestFilter) return "the filter is too large";
    if (bias.count() != channels) return "one bias for each channel expected";
    work_ += output(op).count() * (weights.count() / channels);
    if (work_ > kMostWork) return "more than 10 billion multiplications by now, expected a network for live pictures";
    return check_window(op, weights.shape[1], weights.shape[2], channels);
  }
  const char* check_pool(const NetOp& op) const {
    return check_window(op, op.filter_rows, op.filter_columns, picture(input(op, 0)) ? input(op, 0).shape[3] : 0);
  }
  const char* check_prelu(const NetOp& op) const {
    if (!picture(input(op, 0)) || input(op, 1).numbers.size() != static_cast<std::size_t>(input(op, 0).shape[3]))
      return "one slope for each channel expected";
    return same_shapes(op, {0, 0});
  }
  const char* check_pad(const NetOp& op) const {
    const NetTensor &in = input(op, 0), &out = output(op), &by = input(op, 1);
    if (!picture(in) || !picture(out) || by.integers.size() != 8) return "pictures and eight paddings expected";
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t before = by.integers[2 * i], after = by.integers[2 * i + 1];
      if (before < 0 || after < 0 || in.shape[i] + before + after != out.shape[i])
        return "paddings do not fit the output";
    }
    return nullptr;
  }
  const char* check_resize(const NetOp& op) const {
    const NetTensor &in = input(op, 0), &out = output(op), &size = input(op, 1);
    if (!picture(in) || !picture(out) || size.integers.size() != 2 || in.shape[3] != out.shape[3] ||
        size.integers[0] != out.shape[1] || size.integers[1] != out.shape[2])
      return "the output has another size than asked for";
    return nullptr;
  }
  const char* check_reshape(const NetOp& op) const {
    if (input(op, 0).count() != output(op).count()) return "the output has another number of elements";
    if (output(op).shape.size() > 3 || output(op).shape.empty() || output(op).shape[0] != 1)
      return "only reshaping to two or three dimensions is known";
    return nullptr;
  }
  const char* check_concat(const NetOp& op) const {
    const NetTensor& out = output(op);
    const int rank = static_cast<int>(out.shape.size());
    const int axis = op.axis < 0 ? op.axis + rank : op.axis;
    if (axis < 1 || axis >= rank) return "axis out of range";
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < op.inputs.size(); ++i) {
      std::vector<int> shape = input(op, i).shape;
      if (shape.size() != out.shape.size()) return "operands differ in their number of dimensions";
      sum += std::exchange(shape[static_cast<std::size_t>(axis)], out.shape[static_cast<std::size_t>(axis)]);
      if (shape != out.shape) return "operands and output differ in shape";
    }
    return sum == out.shape[static_cast<std::size_t>(axis)] ? nullptr : "the output has the wrong size";
  }
  const char* check_mean(const NetOp& op) const {
    using Axes = std::vector<std::int32_t>;
    const NetTensor &in = input(op, 0), &out = output(op);
    const Axes& axes = input(op, 1).integers;
    if (!picture(in) || (axes != Axes{1, 2} && axes != Axes{2, 1}) || out.shape.empty() || out.shape[0] != 1 ||
        (out.shape.size() != 2 && out.shape.size() != 4) || out.shape.back() != in.shape[3] ||
        out.count() != in.shape[3])
      return "a mean over rows and columns expected";
    return nullptr;
  }
  const char* check_fully_connected(const NetOp& op) const {
    const NetTensor &in = input(op, 0), &weights = input(op, 1), &bias = input(op, 2), &out = output(op);
    if (weights.shape.size() != 2 || weights.numbers.empty() || bias.numbers.empty() ||
        in.count() != weights.shape[1] || bias.count() != weights.shape[0] ||
        out.shape != std::vector<int>{1, weights.shape[0]})
      return "weights do not fit input and output";
    if (in.shape.empty() || in.count() != in.shape.back()) return "one row expected";
    return nullptr;
  }

  const NetGraph& graph_;
  std::string_view source_;
  std::vector<bool> known_;
  std::int64_t work_ = 0;
};

}  // namespace

NetPadding same_padding(int size, int filter, int stride) noexcept {
  const int out = (size + stride - 1) / stride;
  const int both = std::max(0, (out - 1) * stride + filter - size);
  return {both / 2, both - both / 2};
}

Result<void> check_graph(const NetGraph& graph, std::string_view source) { return GraphCheck(graph, source).run(); }

}  // namespace dubsar
