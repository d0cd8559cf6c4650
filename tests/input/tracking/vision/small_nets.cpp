#include "tests/input/tracking/vision/small_nets.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

// ---- operations by their definitions; pictures are rows x columns x channels

struct Shape {
  int h, w, c;
};
Shape shape_of(const NetTensor& t) { return {t.shape[1], t.shape[2], t.shape[3]}; }

}  // namespace

NetGraph tiny_net() {
  NetGraph g;
  std::uint32_t state = 7;
  const auto data = [&](std::vector<int> shape) {
    g.tensors.push_back({std::move(shape), false, {}, {}});
    return static_cast<int>(g.tensors.size()) - 1;
  };
  const auto weights = [&](std::vector<int> shape) {
    NetTensor t{std::move(shape), true, {}, {}};
    t.numbers.resize(static_cast<std::size_t>(t.count()));
    for (float& number : t.numbers) {
      state = state * 1664525u + 1013904223u;
      number = 0.125f * static_cast<float>(static_cast<int>(state >> 28) - 7);
    }
    g.tensors.push_back(std::move(t));
    return static_cast<int>(g.tensors.size()) - 1;
  };
  const auto whole = [&](std::vector<int> shape, std::vector<std::int32_t> values) {
    g.tensors.push_back({std::move(shape), true, {}, std::move(values)});
    return static_cast<int>(g.tensors.size()) - 1;
  };
  const auto op = [&](NetOpKind kind, std::vector<int> inputs, int output) -> NetOp& {
    NetOp o;
    o.kind = kind;
    o.inputs = std::move(inputs);
    o.output = output;
    g.ops.push_back(std::move(o));
    return g.ops.back();
  };
  g.input = data({1, 7, 6, 3});
  const int a = data({1, 4, 3, 4});
  NetOp& first = op(NetOpKind::kConv, {g.input, weights({4, 3, 3, 3}), weights({4})}, a);
  first.stride_rows = first.stride_columns = 2;
  first.activation = NetActivation::kRelu6;
  const int b = data({1, 4, 3, 4}), c = data({1, 4, 3, 4}), d = data({1, 4, 3, 6}), e = data({1, 4, 3, 6}),
            f = data({1, 4, 3, 6});
  op(NetOpKind::kDepthwiseConv, {a, weights({1, 3, 3, 4}), weights({4})}, b);
  op(NetOpKind::kPrelu, {b, weights({1, 1, 4})}, c);
  op(NetOpKind::kPad, {c, whole({4, 2}, {0, 0, 0, 0, 0, 0, 0, 2})}, d);
  op(NetOpKind::kConv, {c, weights({6, 1, 1, 4}), weights({6})}, e);
  op(NetOpKind::kAdd, {d, e}, f).activation = NetActivation::kRelu;
  const int pooled = data({1, 2, 2, 6}), large = data({1, 4, 4, 6}), h = data({1, 2, 2, 6}), k = data({1, 2, 2, 6});
  NetOp& pool = op(NetOpKind::kMaxPool, {f}, pooled);
  pool.stride_rows = pool.stride_columns = pool.filter_rows = pool.filter_columns = 2;
  op(NetOpKind::kResizeBilinear, {pooled, whole({2}, {4, 4})}, large).half_pixel_centres = true;
  NetOp& valid = op(NetOpKind::kConv, {large, weights({6, 3, 3, 6}), weights({6})}, h);
  valid.same_padding = false;
  op(NetOpKind::kRelu6, {h}, k);
  const int head_a = data({1, 4, 6}), head_b = data({1, 16, 6}), joined = data({1, 20, 6});
  op(NetOpKind::kReshape, {k}, head_a);
  op(NetOpKind::kReshape, {large}, head_b);
  op(NetOpKind::kConcat, {head_a, head_b}, joined).axis = 1;
  const int mean = data({1, 6}), row = data({1, 5}), one = data({1, 1}), sure = data({1, 1});
  op(NetOpKind::kMean, {large, whole({2}, {1, 2})}, mean);
  op(NetOpKind::kFullyConnected, {mean, weights({5, 6}), weights({5})}, row);
  op(NetOpKind::kFullyConnected, {mean, weights({1, 6}), weights({1})}, one);
  op(NetOpKind::kLogistic, {one}, sure);
  g.outputs = {row, joined, sure};
  return g;
}

std::vector<std::vector<float>> run_by_hand(const NetGraph& graph, const std::vector<float>& picture) {
  std::vector<std::vector<float>> values(graph.tensors.size());
  values[static_cast<std::size_t>(graph.input)] = picture;
  for (const NetOp& op : graph.ops) {
    const auto tensor = [&](std::size_t i) -> const NetTensor& {
      return graph.tensors[static_cast<std::size_t>(op.inputs[i])];
    };
    const auto value = [&](std::size_t i) -> const std::vector<float>& {
      return values[static_cast<std::size_t>(op.inputs[i])];
    };
    const NetTensor& out_tensor = graph.tensors[static_cast<std::size_t>(op.output)];
    std::vector<float> out(static_cast<std::size_t>(out_tensor.count()));
    const auto windows = [&](int filter_rows, int filter_columns, const auto& each) {
      const Shape in = shape_of(tensor(0)), to = shape_of(out_tensor);
      const int top = op.same_padding ? same_padding(in.h, filter_rows, op.stride_rows).before : 0;
      const int left = op.same_padding ? same_padding(in.w, filter_columns, op.stride_columns).before : 0;
      for (int y = 0; y < to.h; ++y)
        for (int x = 0; x < to.w; ++x)
          for (int o = 0; o < to.c; ++o) {
            float& result = out[static_cast<std::size_t>((y * to.w + x) * to.c + o)];
            each(result, o, [&](const auto& inner) {
              for (int fy = 0; fy < filter_rows; ++fy)
                for (int fx = 0; fx < filter_columns; ++fx) {
                  const int iy = y * op.stride_rows - top + fy, ix = x * op.stride_columns - left + fx;
                  if (iy >= 0 && iy < in.h && ix >= 0 && ix < in.w)
                    inner(fy, fx, &value(0)[static_cast<std::size_t>((iy * in.w + ix) * in.c)]);
                }
            });
          }
    };
    switch (op.kind) {
      case NetOpKind::kConv: {
        const auto& w = tensor(1);
        windows(w.shape[1], w.shape[2], [&](float& result, int o, const auto& each) {
          result = tensor(2).numbers[static_cast<std::size_t>(o)];
          each([&](int fy, int fx, const float* in) {
            for (int i = 0; i < w.shape[3]; ++i)
              result += in[i] *
                        w.numbers[static_cast<std::size_t>(((o * w.shape[1] + fy) * w.shape[2] + fx) * w.shape[3] + i)];
          });
        });
        break;
      }
      case NetOpKind::kDepthwiseConv: {
        const auto& w = tensor(1);
        const int multiplier = w.shape[3] / tensor(0).shape[3];
        windows(w.shape[1], w.shape[2], [&](float& result, int o, const auto& each) {
          result = tensor(2).numbers[static_cast<std::size_t>(o)];
          each([&](int fy, int fx, const float* in) {
            result += in[o / multiplier] * w.numbers[static_cast<std::size_t>((fy * w.shape[2] + fx) * w.shape[3] + o)];
          });
        });
        break;
      }
      case NetOpKind::kMaxPool:
        windows(op.filter_rows, op.filter_columns, [&](float& result, int o, const auto& each) {
          result = -1e30f;
          each([&](int, int, const float* in) { result = std::max(result, in[o]); });
        });
        break;
      case NetOpKind::kAdd:
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = value(0)[i] + value(1)[i];
        break;
      case NetOpKind::kPrelu:
        for (std::size_t i = 0; i < out.size(); ++i) {
          const float v = value(0)[i];
          out[i] = v >= 0 ? v : v * tensor(1).numbers[i % tensor(1).numbers.size()];
        }
        break;
      case NetOpKind::kRelu:
      case NetOpKind::kRelu6:
        for (std::size_t i = 0; i < out.size(); ++i)
          out[i] = std::clamp(value(0)[i], 0.0f, op.kind == NetOpKind::kRelu6 ? 6.0f : 1e30f);
        break;
      case NetOpKind::kLogistic:
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = 1.0f / (1.0f + std::exp(-value(0)[i]));
        break;
      case NetOpKind::kPad: {
        const Shape in = shape_of(tensor(0)), to = shape_of(out_tensor);
        const auto& by = tensor(1).integers;
        for (int y = 0; y < in.h; ++y)
          for (int x = 0; x < in.w; ++x)
            for (int c = 0; c < in.c; ++c)
              out[static_cast<std::size_t>(((y + by[2]) * to.w + x + by[4]) * to.c + c + by[6])] =
                  value(0)[static_cast<std::size_t>((y * in.w + x) * in.c + c)];
        break;
      }
      case NetOpKind::kResizeBilinear: {
        const Shape in = shape_of(tensor(0)), to = shape_of(out_tensor);
        const auto source = [&](int i, int from, int size) {
          const auto scale = op.align_corners && size > 1 ? static_cast<float>(from - 1) / static_cast<float>(size - 1)
                                                          : static_cast<float>(from) / static_cast<float>(size);
          const float at =
              op.half_pixel_centres ? (static_cast<float>(i) + 0.5f) * scale - 0.5f : static_cast<float>(i) * scale;
          return std::clamp(at, 0.0f, static_cast<float>(from - 1));
        };
        for (int y = 0; y < to.h; ++y)
          for (int x = 0; x < to.w; ++x)
            for (int c = 0; c < to.c; ++c) {
              const float v = source(y, in.h, to.h), u = source(x, in.w, to.w);
              const int y0 = static_cast<int>(v), x0 = static_cast<int>(u), y1 = std::min(y0 + 1, in.h - 1),
                        x1 = std::min(x0 + 1, in.w - 1);
              const auto at = [&](int r, int s) {
                return value(0)[static_cast<std::size_t>((r * in.w + s) * in.c + c)];
              };
              const float du = u - static_cast<float>(x0), dv = v - static_cast<float>(y0);
              out[static_cast<std::size_t>((y * to.w + x) * to.c + c)] =
                  (1 - dv) * ((1 - du) * at(y0, x0) + du * at(y0, x1)) + dv * ((1 - du) * at(y1, x0) + du * at(y1, x1));
            }
        break;
      }
      case NetOpKind::kReshape:
        out = value(0);
        break;
      case NetOpKind::kConcat: {
        const auto axis = static_cast<std::size_t>(op.axis);
        std::size_t inner = 1, outer = 1;
        for (std::size_t i = axis + 1; i < out_tensor.shape.size(); ++i)
          inner *= static_cast<std::size_t>(out_tensor.shape[i]);
        for (std::size_t i = 0; i < axis; ++i) outer *= static_cast<std::size_t>(out_tensor.shape[i]);
        std::size_t at = 0;
        for (std::size_t o = 0; o < outer; ++o)
          for (std::size_t i = 0; i < op.inputs.size(); ++i) {
            const std::size_t run = inner * static_cast<std::size_t>(tensor(i).shape[axis]);
            std::copy_n(value(i).begin() + static_cast<std::ptrdiff_t>(o * run), run,
                        out.begin() + static_cast<std::ptrdiff_t>(at));
            at += run;
          }
        break;
      }
      case NetOpKind::kMean: {
        const Shape in = shape_of(tensor(0));
        for (int i = 0; i < in.h * in.w; ++i)
          for (int c = 0; c < in.c; ++c)
            out[static_cast<std::size_t>(c)] +=
                value(0)[static_cast<std::size_t>(i * in.c + c)] / static_cast<float>(in.h * in.w);
        break;
      }
      case NetOpKind::kFullyConnected:
        for (std::size_t o = 0; o < out.size(); ++o) {
          out[o] = tensor(2).numbers[o];
          for (std::size_t i = 0; i < value(0).size(); ++i)
            out[o] += value(0)[i] * tensor(1).numbers[o * value(0).size() + i];
        }
        break;
    }
    if (op.activation != NetActivation::kNone)
      for (float& v : out) v = std::clamp(v, 0.0f, op.activation == NetActivation::kRelu6 ? 6.0f : 1e30f);
    values[static_cast<std::size_t>(op.output)] = std::move(out);
  }
  std::vector<std::vector<float>> outputs;
  for (const int output : graph.outputs) outputs.push_back(values[static_cast<std::size_t>(output)]);
  return outputs;
}

}  // namespace dubsar
