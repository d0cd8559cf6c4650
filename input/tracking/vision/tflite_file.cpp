#include "input/tracking/vision/tflite_file.h"

#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "input/tracking/vision/flat_buffer.h"

namespace dubsar {
namespace {

using Table = FlatBuffer::Table;
using Vector = FlatBuffer::Vector;

constexpr std::uint32_t kMostTensors = 8192, kMostOps = 4096, kMostDimensions = 8;
constexpr std::int64_t kMostConstants = std::int64_t{1} << 25;  // all together; several tensors may name one buffer

enum TensorType : std::int8_t { kFloat32 = 0, kFloat16 = 1, kInt32 = 2 };

constexpr int kDequantize = 6;
std::optional<NetOpKind> kind_of(int code) {
  switch (code) {
    case 0:
      return NetOpKind::kAdd;
    case 2:
      return NetOpKind::kConcat;
    case 3:
      return NetOpKind::kConv;
    case 4:
      return NetOpKind::kDepthwiseConv;
    case 9:
      return NetOpKind::kFullyConnected;
    case 14:
      return NetOpKind::kLogistic;
    case 17:
      return NetOpKind::kMaxPool;
    case 19:
      return NetOpKind::kRelu;
    case 21:
      return NetOpKind::kRelu6;
    case 22:
      return NetOpKind::kReshape;
    case 23:
      return NetOpKind::kResizeBilinear;
    case 34:
      return NetOpKind::kPad;
    case 40:
      return NetOpKind::kMean;
    case 54:
      return NetOpKind::kPrelu;
    default:
      return std::nullopt;
  }
}

float widened(std::uint16_t half) {
  const float sign = (half & 0x8000u) != 0 ? -1.0f : 1.0f;
  const int exponent = (half >> 10) & 31, mantissa = half & 1023;
  if (exponent == 0) return sign * std::ldexp(static_cast<float>(mantissa), -24);
  if (exponent == 31)
    return mantissa == 0 ? sign * std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  return sign * std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25);
}

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, std::string_view source) : file_(bytes), source_(source) {}

  Result<NetGraph> read() {
    const Table model = file_.root();
    if (const auto version = file_.value<std::uint32_t>(model, 0, 0); !file_.ok() || version != 3)
      return fail(ErrorKind::kBadData, "{}: not a TensorFlow Lite model of version 3", source_);
    const Vector graphs = file_.vector(model, 2, 4);
    if (graphs.count != 1) return fail(ErrorKind::kBadData, "{}: {} graphs found, expected 1", source_, graphs.count);
    const Table subgraph = file_.element_table(graphs, 0);
    DUBSAR_TRY(read_tensors(subgraph, file_.vector(model, 4, 4)));
    DUBSAR_TRY(read_ops(subgraph, file_.vector(model, 1, 4)));
    const std::vector<int> inputs = integers(file_.vector(subgraph, 1, 4));
    graph_.outputs = integers(file_.vector(subgraph, 2, 4));
    if (!file_.ok()) return fail(ErrorKind::kBadData, "{}: damaged: something lies outside the file", source_);
    if (inputs.size() != 1) return fail(ErrorKind::kBadData, "{}: {} inputs found, expected 1", source_, inputs.size());
    graph_.input = inputs[0];
    DUBSAR_TRY(check_graph(graph_, source_));
    return std::move(graph_);
  }

 private:
  std::vector<int> integers(const Vector& vector) {
    std::vector<int> out(std::min<std::uint32_t>(vector.count, kMostTensors));
    for (std::uint32_t i = 0; i < out.size(); ++i) out[i] = file_.element<std::int32_t>(vector, i);
    return out;
  }

  Result<void> read_tensors(const Table& subgraph, const Vector& buffers) {
    const Vector tensors = file_.vector(subgraph, 0, 4);
    if (tensors.count > kMostTensors)
      return fail(ErrorKind::kBadData, "{}: {} tensors found, expected at most {}", source_, tensors.count,
                  kMostTensors);
    graph_.tensors.resize(tensors.count);
    for (std::uint32_t i = 0; i < tensors.count && file_.ok(); ++i) {
      const Table table = file_.element_table(tensors, i);
      NetTensor& tensor = graph_.tensors[i];
      const Vector shape = file_.vector(table, 0, 4);
      if (shape.count > kMostDimensions)
        return fail(ErrorKind::kBadData, "{}: tensor {} has {} dimensions", source_, i, shape.count);
      tensor.shape = integers(shape);
      const auto buffer = file_.value<std::uint32_t>(table, 2, 0);
      if (buffer >= buffers.count)
        return fail(ErrorKind::kBadData, "{}: tensor {} names a buffer that is not there", source_, i);
      const Vector data = file_.vector(file_.element_table(buffers, buffer), 0, 1);
      if (data.count == 0) continue;
      if (file_.vector(file_.table(table, 6), 0, 4).count > 0)
        return fail(ErrorKind::kBadData, "{}: sparse weights are not known", source_);
      tensor.constant = true;
      DUBSAR_TRY(read_constant(i, file_.value<std::int8_t>(table, 1, kFloat32), file_.bytes_of(data), tensor));
    }
    return {};
  }

  Result<void> read_constant(std::uint32_t i, int type, std::span<const std::byte> bytes, NetTensor& tensor) {
    const std::size_t width = type == kFloat16 ? 2 : 4;
    if (type != kFloat32 && type != kFloat16 && type != kInt32)
      return fail(ErrorKind::kBadData,
                  "{}: tensor {} has numbers of type {}, expected 32- or 16-bit floats or 32-bit integers", source_, i,
                  type);
    const std::size_t count = bytes.size() / width;
    constants_ += static_cast<std::int64_t>(count);
    if (count * width != bytes.size() || constants_ > kMostConstants)
      return fail(ErrorKind::kBadData, "{}: tensor {} has {} bytes", source_, i, bytes.size());
    if (type == kFloat32) {
      tensor.numbers.resize(count);
      std::memcpy(tensor.numbers.data(), bytes.data(), bytes.size());
    } else if (type == kInt32) {
      tensor.integers.resize(count);
      std::memcpy(tensor.integers.data(), bytes.data(), bytes.size());
    } else {
      tensor.numbers.resize(count);
      for (std::size_t k = 0; k < count; ++k) {
        std::uint16_t half = 0;
        std::memcpy(&half, bytes.data() + 2 * k, 2);
        tensor.numbers[k] = widened(half);
      }
    }
    for (const float number : tensor.numbers)
      if (!std::isfinite(number))
        return fail(ErrorKind::kBadData, "{}: tensor {} has a weight that is not finite", source_, i);
    return {};
  }

  Result<void> read_ops(const Table& subgraph, const Vector& codes) {
    const Vector ops = file_.vector(subgraph, 3, 4);
    if (ops.count > kMostOps)
      return fail(ErrorKind::kBadData, "{}: {} operations found, expected at most {}", source_, ops.count, kMostOps);
    for (std::uint32_t i = 0; i < ops.count && file_.ok(); ++i) {
      const Table table = file_.element_table(ops, i);
      const auto which = file_.value<std::uint32_t>(table, 0, 0);
      if (which >= codes.count) return fail(ErrorKind::kBadData, "{}: operation {} has no code", source_, i);
      const Table code_table = file_.element_table(codes, which);
      const int code =
          std::max<int>(file_.value<std::int8_t>(code_table, 0, 0), file_.value<std::int32_t>(code_table, 3, 0));
      NetOp op;
      op.inputs = integers(file_.vector(table, 1, 4));
      const std::vector<int> outputs = integers(file_.vector(table, 2, 4));
      if (outputs.size() != 1)
        return fail(ErrorKind::kBadData, "{}: operation {} has {} outputs, expected 1", source_, i, outputs.size());
      op.output = outputs[0];
      if (code == kDequantize) {
        DUBSAR_TRY(widen(op, i));
        continue;
      }
      const auto kind = kind_of(code);
      if (!kind)
        return fail(ErrorKind::kBadData, "{}: operation {} has code {}, which is not one of the known ones", source_, i,
                    code);
      op.kind = *kind;
      DUBSAR_TRY(read_options(file_.table(table, 4), i, op));
      graph_.ops.push_back(std::move(op));
    }
    return {};
  }

  /// Weights kept in 16 bits are widened when they are read; the operation that does it only gives them a new
  /// number.
  Result<void> widen(const NetOp& op, std::uint32_t i) {
    const auto there = [&](int tensor) {
      return tensor >= 0 && static_cast<std::size_t>(tensor) < graph_.tensors.size();
    };
    if (op.inputs.size() == 1 && there(op.inputs[0]) && there(op.output) && op.inputs[0] != op.output) {
      NetTensor& from = graph_.tensors[static_cast<std::size_t>(op.inputs[0])];
      NetTensor& to = graph_.tensors[static_cast<std::size_t>(op.output)];
      if (from.constant && !to.constant && from.shape == to.shape && !from.numbers.empty()) {
        constants_ += static_cast<std::int64_t>(from.numbers.size());
        if (constants_ > kMostConstants) return fail(ErrorKind::kBadData, "{}: too many weights", source_);
        to.constant = true;
        to.numbers = from.numbers;
        return {};
      }
    }
    return fail(ErrorKind::kBadData, "{}: operation {} widens what is not a constant", source_, i);
  }

  Result<void> read_options(const Table& options, std::uint32_t i, NetOp& op) {
    int activation = 0, dilation = 1, weights_format = 0;
    switch (op.kind) {
      case NetOpKind::kConv:
      case NetOpKind::kDepthwiseConv: {
        const int shift =
            op.kind == NetOpKind::kDepthwiseConv ? 1 : 0;  // the depth multiplier, which the shapes say too
        read_window(options, op);
        activation = file_.value<std::int8_t>(options, 3 + shift, 0);
        dilation = std::max(file_.value<std::int32_t>(options, 4 + shift, 1),
                            file_.value<std::int32_t>(options, 5 + shift, 1));
        break;
      }
      case NetOpKind::kMaxPool:
        read_window(options, op);
        op.filter_columns = file_.value<std::int32_t>(options, 3, 0);
        op.filter_rows = file_.value<std::int32_t>(options, 4, 0);
        activation = file_.value<std::int8_t>(options, 5, 0);
        break;
      case NetOpKind::kAdd:
        activation = file_.value<std::int8_t>(options, 0, 0);
        break;
      case NetOpKind::kFullyConnected:
        activation = file_.value<std::int8_t>(options, 0, 0);
        weights_format = file_.value<std::int8_t>(options, 1, 0);
        break;
      case NetOpKind::kConcat:
        op.axis = file_.value<std::int32_t>(options, 0, 0);
        activation = file_.value<std::int8_t>(options, 1, 0);
        break;
      case NetOpKind::kResizeBilinear:
        op.align_corners = file_.value<std::uint8_t>(options, 2, 0) != 0;
        op.half_pixel_centres = file_.value<std::uint8_t>(options, 3, 0) != 0;
        break;
      case NetOpKind::kPrelu:
      case NetOpKind::kRelu:
      case NetOpKind::kRelu6:
      case NetOpKind::kPad:
      case NetOpKind::kReshape:
      case NetOpKind::kMean:
      case NetOpKind::kLogistic:
        break;
    }
    if (dilation != 1 || weights_format != 0)
      return fail(ErrorKind::kBadData, "{}: operation {}: dilated or shuffled filters are not known", source_, i);
    if (activation != 0 && activation != 1 && activation != 3)
      return fail(ErrorKind::kBadData, "{}: operation {}: activation {} found, expected none, relu or relu6", source_,
                  i, activation);
    op.activation = activation == 0   ? NetActivation::kNone
                    : activation == 1 ? NetActivation::kRelu
                                      : NetActivation::kRelu6;
    return {};
  }

  void read_window(const Table& options, NetOp& op) {
    op.same_padding = file_.value<std::int8_t>(options, 0, 0) == 0;
    op.stride_columns = file_.value<std::int32_t>(options, 1, 0);
    op.stride_rows = file_.value<std::int32_t>(options, 2, 0);
  }

  FlatBuffer file_;
  std::string_view source_;
  NetGraph graph_;
  std::int64_t constants_ = 0;
};

}  // namespace

Result<NetGraph> read_tflite(std::span<const std::byte> bytes, std::string_view source) {
  return Reader(bytes, source).read();
}

}  // namespace dubsar
