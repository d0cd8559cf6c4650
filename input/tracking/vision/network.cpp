// The only file that includes OpenCV's dnn.

#include "input/tracking/vision/network.h"

#include <cstring>
#include <opencv2/core/utility.hpp>
#include <opencv2/dnn.hpp>
#include <string>

#include "core/base/files/input_file.h"
#include "input/tracking/vision/tflite_file.h"

namespace dubsar {
namespace {

using cv::dnn::DictValue;
using cv::dnn::LayerParams;
constexpr std::int64_t kMostBytes = std::int64_t{32} << 20;

std::string name_of(int tensor) { return fmt::format("t{}", tensor); }

DictValue list(const std::vector<int>& numbers) {
  return DictValue::arrayInt(numbers.data(), static_cast<int>(numbers.size()));
}

/// OpenCV keeps pictures as channels x rows x columns, the file as rows x columns x channels. Only pictures
/// (four dimensions) differ; what is made of one by reshaping goes through a permutation.
class Builder {
 public:
  explicit Builder(const NetGraph& graph) : graph_(graph), layers_(graph.tensors.size(), -1) {
    layers_[static_cast<std::size_t>(graph.input)] = 0;
    net_.setInputsNames({name_of(graph.input)});
  }

  cv::dnn::Net build() {
    for (const NetOp& op : graph_.ops) add(op);
    net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return std::move(net_);
  }

 private:
  const NetTensor& tensor(int i) const { return graph_.tensors[static_cast<std::size_t>(i)]; }

  int layer(const std::string& name, const char* type, LayerParams& params, const std::vector<int>& from) {
    const int id = net_.addLayer(name, type, params);
    for (std::size_t i = 0; i < from.size(); ++i) net_.connect(from[i], 0, id, static_cast<int>(i));
    return id;
  }

  /// The layer of an operation and that of its activation; only the last one has the output's name.
  void finish(const NetOp& op, const char* type, LayerParams& params) {
    std::vector<int> from;
    for (const int input : op.inputs)
      if (!tensor(input).constant) from.push_back(layers_[static_cast<std::size_t>(input)]);
    finish_from(op, type, params, from);
  }
  void finish_from(const NetOp& op, const char* type, LayerParams& params, const std::vector<int>& from) {
    const std::string name = name_of(op.output);
    if (op.activation == NetActivation::kNone) {
      layers_[static_cast<std::size_t>(op.output)] = layer(name, type, params, from);
      return;
    }
    const int raw = layer(name + "_raw", type, params, from);
    LayerParams none;
    const char* const activation = op.activation == NetActivation::kRelu ? "ReLU" : "ReLU6";
    layers_[static_cast<std::size_t>(op.output)] = layer(name, activation, none, {raw});
  }

  /// Rows x columns x channels, as the file has it.
  int as_in_file(const NetOp& op, int input) {
    const int from = layers_[static_cast<std::size_t>(input)];
    if (tensor(input).shape.size() != 4) return from;
    LayerParams params;
    params.set("order", list({0, 2, 3, 1}));
    return layer(name_of(op.output) + "_order", "Permute", params, {from});
  }

  void add(const NetOp& op) {
    LayerParams params;
    switch (op.kind) {
      case NetOpKind::kConv:
      case NetOpKind::kDepthwiseConv:
        return add_conv(op, params);
      case NetOpKind::kAdd:
        params.set("operation", "sum");
        return finish(op, "Eltwise", params);
      case NetOpKind::kPrelu: {
        const NetTensor& slopes = tensor(op.inputs[1]);
        params.blobs.emplace_back(
            cv::Mat(1, static_cast<int>(slopes.numbers.size()), CV_32F, const_cast<float*>(slopes.numbers.data()))
                .clone());
        return finish(op, "PReLU", params);
      }
      case NetOpKind::kRelu:
        return finish(op, "ReLU", params);
      case NetOpKind::kRelu6:
        return finish(op, "ReLU6", params);
      case NetOpKind::kLogistic:
        return finish(op, "Sigmoid", params);
      case NetOpKind::kPad: {
        const auto& by = tensor(op.inputs[1]).integers;
        params.set("paddings", list({by[0], by[1], by[6], by[7], by[2], by[3], by[4], by[5]}));
        return finish(op, "Padding", params);
      }
      case NetOpKind::kMaxPool:
        params.set("pool", "max");
        params.set("ceil_mode", false);
        set_window(op, op.filter_rows, op.filter_columns, padding_of(op, op.filter_rows, op.filter_columns), params);
        return finish(op, "Pooling", params);
      case NetOpKind::kResizeBilinear:
        params.set("interpolation", "bilinear");
        params.set("height", tensor(op.output).shape[1]);
        params.set("width", tensor(op.output).shape[2]);
        params.set("align_corners", op.align_corners);
        params.set("half_pixel_centers", op.half_pixel_centres);
        return finish(op, "Resize", params);
      case NetOpKind::kReshape: {
        params.set("dim", list(tensor(op.output).shape));
        return finish_from(op, "Reshape", params, {as_in_file(op, op.inputs[0])});
      }
      case NetOpKind::kConcat: {
        const bool picture = tensor(op.output).shape.size() == 4;
        const int axis = op.axis < 0 ? op.axis + static_cast<int>(tensor(op.output).shape.size()) : op.axis;
        params.set("axis", !picture ? axis : axis == 3 ? 1 : axis + 1);
        return finish(op, "Concat", params);
      }
      case NetOpKind::kMean: {
        params.set("pool", "ave");
        params.set("global_pooling", true);
        if (tensor(op.output).shape.size() == 4) return finish(op, "Pooling", params);
        const int mean =
            layer(name_of(op.output) + "_mean", "Pooling", params, {layers_[static_cast<std::size_t>(op.inputs[0])]});
        LayerParams flat;
        flat.set("axis", 1);
        return finish_from(op, "Flatten", flat, {mean});
      }
      case NetOpKind::kFullyConnected: {
        LayerParams flat;
        flat.set("axis", 1);
        const int row =
            layer(name_of(op.output) + "_row", "Flatten", flat, {layers_[static_cast<std::size_t>(op.inputs[0])]});
        const NetTensor &weights = tensor(op.inputs[1]), &bias = tensor(op.inputs[2]);
        params.set("axis", 1);
        params.set("num_output", weights.shape[0]);
        params.set("bias_term", true);
        params.blobs.emplace_back(
            cv::Mat(weights.shape[0], weights.shape[1], CV_32F, const_cast<float*>(weights.numbers.data())).clone());
        params.blobs.emplace_back(
            cv::Mat(1, weights.shape[0], CV_32F, const_cast<float*>(bias.numbers.data())).clone());
        return finish_from(op, "InnerProduct", params, {row});
      }
    }
  }

  struct Padding {
    NetPadding rows, columns;
    bool symmetric() const noexcept { return rows.before == rows.after && columns.before == columns.after; }
  };
  Padding padding_of(const NetOp& op, int filter_rows, int filter_columns) const {
    const auto& in = tensor(op.inputs[0]).shape;
    if (!op.same_padding) return {};
    return {same_padding(in[1], filter_rows, op.stride_rows), same_padding(in[2], filter_columns, op.stride_columns)};
  }

  static void set_window(const NetOp& op, int filter_rows, int filter_columns, const Padding& padding,
                         LayerParams& params) {
    params.set("kernel_h", filter_rows);
    params.set("kernel_w", filter_columns);
    params.set("stride_h", op.stride_rows);
    params.set("stride_w", op.stride_columns);
    params.set("pad_t", padding.rows.before);
    params.set("pad_b", padding.rows.after);
    params.set("pad_l", padding.columns.before);
    params.set("pad_r", padding.columns.after);
  }

  void add_conv(const NetOp& op, LayerParams& params) {
    const NetTensor &weights = tensor(op.inputs[1]), &bias = tensor(op.inputs[2]);
    const bool depthwise = op.kind == NetOpKind::kDepthwiseConv;
    const int filter_rows = weights.shape[1], filter_columns = weights.shape[2];
    const int out = weights.shape[depthwise ? 3 : 0], in = depthwise ? 1 : weights.shape[3];
    const int size[] = {out, in, filter_rows, filter_columns};
    cv::Mat filters(4, size, CV_32F);
    auto* to = filters.ptr<float>();
    for (int o = 0; o < out; ++o)
      for (int i = 0; i < in; ++i)
        for (int y = 0; y < filter_rows; ++y)
          for (int x = 0; x < filter_columns; ++x) {
            const int at =
                depthwise ? (y * filter_columns + x) * out + o : ((o * filter_rows + y) * filter_columns + x) * in + i;
            *to++ = weights.numbers[static_cast<std::size_t>(at)];
          }
    Padding padding = padding_of(op, filter_rows, filter_columns);
    int from = layers_[static_cast<std::size_t>(op.inputs[0])];
    if (!padding.symmetric()) {  // OpenCV's convolution knows only symmetric padding
      LayerParams around;
      around.set("paddings", list({0, 0, 0, 0, padding.rows.before, padding.rows.after, padding.columns.before,
                                   padding.columns.after}));
      from = layer(name_of(op.output) + "_padded", "Padding", around, {from});
      padding = {};
    }
    set_window(op, filter_rows, filter_columns, padding, params);
    params.set("num_output", out);
    params.set("group", depthwise ? tensor(op.inputs[0]).shape[3] : 1);
    params.set("bias_term", true);
    params.blobs.push_back(filters);
    params.blobs.emplace_back(cv::Mat(1, out, CV_32F, const_cast<float*>(bias.numbers.data())).clone());
    finish_from(op, "Convolution", params, {from});
  }

  const NetGraph& graph_;
  std::vector<int> layers_;
  cv::dnn::Net net_;
};

}  // namespace

struct Network::Impl {
  cv::dnn::Net net;
  std::vector<cv::String> names;
  std::vector<std::int64_t> counts;
  std::vector<cv::Mat> results;
};

Network::Network(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Network::Network(Network&&) noexcept = default;
Network& Network::operator=(Network&&) noexcept = default;
Network::~Network() = default;

Result<Network> Network::build(const NetGraph& graph, std::string_view source) {
  DUBSAR_TRY(check_graph(graph, source));
  auto impl = std::make_unique<Impl>();
  for (const int output : graph.outputs) {
    const NetTensor& tensor = graph.tensors[static_cast<std::size_t>(output)];
    if (tensor.shape.size() == 4)
      return fail(ErrorKind::kBadData, "{}: output {} is a picture, expected a row or a table", source, output);
    impl->names.push_back(name_of(output));
    impl->counts.push_back(tensor.count());
  }
  try {
    cv::setNumThreads(1);
    impl->net = Builder(graph).build();
  } catch (const cv::Exception& exception) {
    return fail(ErrorKind::kBadData, "{}: OpenCV does not take it: {}", source, exception.what());
  }
  Network network(std::move(impl));
  const NetTensor& input = graph.tensors[static_cast<std::size_t>(graph.input)];
  network.rows_ = input.shape[1];
  network.columns_ = input.shape[2];
  network.channels_ = input.shape[3];
  // a first run makes OpenCV allocate and fuse, and shows a graph that it cannot run
  std::vector<std::vector<float>> outputs;
  if (auto ran = network.run(std::vector<float>(static_cast<std::size_t>(input.count())), outputs); !ran)
    return fail(ErrorKind::kBadData, "{}: {}", source, ran.error().message);
  return network;
}

Result<Network> Network::read(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const InputFile file, InputFile::open(path));
  if (file.size() > kMostBytes)
    return fail(ErrorKind::kBadData, "{}: {} bytes, expected a network of at most {}", path.string(), file.size(),
                kMostBytes);
  DUBSAR_ASSIGN(const std::string bytes, read_bytes(file, 0, file.size()));
  DUBSAR_ASSIGN(const NetGraph graph, read_tflite(std::as_bytes(std::span(bytes.data(), bytes.size())), path.string()));
  return build(graph, path.string());
}

Result<void> Network::run(std::span<const float> planes, std::vector<std::vector<float>>& outputs) {
  DUBSAR_CHECK(planes.size() == static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_) *
                                    static_cast<std::size_t>(channels_));
  try {
    const int size[] = {1, channels_, rows_, columns_};
    impl_->net.setInput(cv::Mat(4, size, CV_32F, const_cast<float*>(planes.data())));
    impl_->net.forward(impl_->results, impl_->names);
    outputs.resize(impl_->names.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const cv::Mat& result = impl_->results[i];
      if (result.type() != CV_32F || !result.isContinuous() ||
          static_cast<std::int64_t>(result.total()) != impl_->counts[i])
        return fail(ErrorKind::kInternal, "network: output {} has {} values, expected {}", i, result.total(),
                    impl_->counts[i]);
      const auto* const values = result.ptr<float>();
      outputs[i].assign(values, values + result.total());
    }
  } catch (const cv::Exception& exception) {
    return fail(ErrorKind::kInternal, "network: {}", exception.what());
  }
  return {};
}

}  // namespace dubsar
