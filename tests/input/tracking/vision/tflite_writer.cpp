#include "tests/input/tracking/vision/tflite_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <variant>

#include "core/base/result.h"

namespace dubsar {
namespace {

// ---- FlatBuffers: a table of fields, each a scalar or a child that is written behind it

struct Node {
  struct Child {
    int field;
    std::shared_ptr<Node> node;
  };
  struct Scalar {
    int field;
    std::vector<std::byte> bytes;
  };
  std::vector<Scalar> scalars;
  std::vector<Child> children;
  bool is_vector = false;           // else a table
  std::vector<std::byte> elements;  // of a vector of numbers
  std::uint32_t count = 0;
  std::vector<std::shared_ptr<Node>> tables;  // of a vector of tables
};
using NodePtr = std::shared_ptr<Node>;

template <class T>
std::vector<std::byte> raw(T value) {
  std::vector<std::byte> bytes(sizeof(T));
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}
template <class T>
void put(Node& node, int field, T value) {
  node.scalars.push_back({field, raw(value)});
}
template <class T>
NodePtr numbers(const std::vector<T>& values) {
  auto node = std::make_shared<Node>();
  node->is_vector = true;
  node->count = static_cast<std::uint32_t>(values.size());
  node->elements.resize(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(node->elements.data(), values.data(), node->elements.size());
  return node;
}
NodePtr tables(std::vector<NodePtr> nodes) {
  auto node = std::make_shared<Node>();
  node->is_vector = true;
  node->tables = std::move(nodes);
  node->count = static_cast<std::uint32_t>(node->tables.size());
  return node;
}

class Writer {
 public:
  std::vector<std::byte> write(const NodePtr& root) {
    append(raw<std::uint32_t>(0));
    append({std::byte{'T'}, std::byte{'F'}, std::byte{'L'}, std::byte{'3'}});
    patch(0, table(*root));
    return std::move(out_);
  }

 private:
  void append(const std::vector<std::byte>& bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }
  void align() {
    while (out_.size() % 8 != 0) out_.push_back(std::byte{0});
  }
  void patch(std::size_t at, std::size_t target) {
    const auto bytes = raw(static_cast<std::uint32_t>(target - at));
    std::copy(bytes.begin(), bytes.end(), out_.begin() + static_cast<std::ptrdiff_t>(at));
  }

  std::size_t table(const Node& node) {
    int fields = 0;
    for (const auto& s : node.scalars) fields = std::max(fields, s.field + 1);
    for (const auto& c : node.children) fields = std::max(fields, c.field + 1);
    align();
    const std::size_t vtable = out_.size();
    std::vector<std::uint16_t> slots(static_cast<std::size_t>(fields) + 2);
    std::size_t size = 4;
    for (const auto& s : node.scalars) {
      slots[static_cast<std::size_t>(s.field) + 2] = static_cast<std::uint16_t>(size);
      size += 4;
    }
    for (const auto& c : node.children) {
      slots[static_cast<std::size_t>(c.field) + 2] = static_cast<std::uint16_t>(size);
      size += 4;
    }
    slots[0] = static_cast<std::uint16_t>(2 * slots.size());
    slots[1] = static_cast<std::uint16_t>(size);
    for (const std::uint16_t slot : slots) append(raw(slot));
    align();
    const std::size_t at = out_.size();
    append(raw(static_cast<std::int32_t>(at - vtable)));
    for (const auto& s : node.scalars) {
      std::vector<std::byte> four = s.bytes;
      four.resize(4);
      append(four);
    }
    const std::size_t first = out_.size();
    for (std::size_t i = 0; i < node.children.size(); ++i) append(raw<std::uint32_t>(0));
    for (std::size_t i = 0; i < node.children.size(); ++i) patch(first + 4 * i, any(*node.children[i].node));
    return at;
  }
  std::size_t any(const Node& node) {
    if (!node.is_vector) return table(node);
    align();
    const std::size_t at = out_.size();
    append(raw(node.count));
    append(node.elements);
    const std::size_t first = out_.size();
    for (std::size_t i = 0; i < node.tables.size(); ++i) append(raw<std::uint32_t>(0));
    for (std::size_t i = 0; i < node.tables.size(); ++i) patch(first + 4 * i, table(*node.tables[i]));
    return at;
  }
  std::vector<std::byte> out_;
};

std::uint16_t half_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if (value == 0.0f) return 0;
  const int exponent = static_cast<int>((bits >> 23) & 255) - 127 + 15;
  DUBSAR_CHECK(exponent > 0 && exponent < 31 && (bits & 0x1fff) == 0);
  return static_cast<std::uint16_t>(((bits >> 16) & 0x8000u) | static_cast<std::uint32_t>(exponent << 10) |
                                    ((bits >> 13) & 0x3ffu));
}

int code_of(NetOpKind kind) {
  static const std::map<NetOpKind, int> codes{
      {NetOpKind::kAdd, 0},           {NetOpKind::kConcat, 2},          {NetOpKind::kConv, 3},
      {NetOpKind::kDepthwiseConv, 4}, {NetOpKind::kFullyConnected, 9},  {NetOpKind::kLogistic, 14},
      {NetOpKind::kMaxPool, 17},      {NetOpKind::kRelu, 19},           {NetOpKind::kRelu6, 21},
      {NetOpKind::kReshape, 22},      {NetOpKind::kResizeBilinear, 23}, {NetOpKind::kPad, 34},
      {NetOpKind::kMean, 40},         {NetOpKind::kPrelu, 54}};
  return codes.at(kind);
}

NodePtr options_of(const NetOp& op) {
  auto node = std::make_shared<Node>();
  const auto activation = static_cast<std::int8_t>(op.activation == NetActivation::kNone   ? 0
                                                   : op.activation == NetActivation::kRelu ? 1
                                                                                           : 3);
  const auto window = [&] {
    put(*node, 0, static_cast<std::int8_t>(op.same_padding ? 0 : 1));
    put(*node, 1, static_cast<std::int32_t>(op.stride_columns));
    put(*node, 2, static_cast<std::int32_t>(op.stride_rows));
  };
  switch (op.kind) {
    case NetOpKind::kConv:
      window();
      put(*node, 3, activation);
      break;
    case NetOpKind::kDepthwiseConv:
      window();
      put(*node, 4, activation);
      break;
    case NetOpKind::kMaxPool:
      window();
      put(*node, 3, static_cast<std::int32_t>(op.filter_columns));
      put(*node, 4, static_cast<std::int32_t>(op.filter_rows));
      put(*node, 5, activation);
      break;
    case NetOpKind::kAdd:
    case NetOpKind::kFullyConnected:
      put(*node, 0, activation);
      break;
    case NetOpKind::kConcat:
      put(*node, 0, static_cast<std::int32_t>(op.axis));
      break;
    case NetOpKind::kResizeBilinear:
      put(*node, 2, static_cast<std::int8_t>(op.align_corners));
      put(*node, 3, static_cast<std::int8_t>(op.half_pixel_centres));
      break;
    default:
      break;
  }
  return node;
}

}  // namespace

std::vector<std::byte> write_tflite(const NetGraph& graph, bool halves) {
  std::vector<NodePtr> buffers{std::make_shared<Node>()}, tensors, ops, codes;
  std::map<int, int> code_index;
  const auto index_of_code = [&](int code) {
    const auto [at, added] = code_index.try_emplace(code, static_cast<int>(codes.size()));
    if (added) {
      auto node = std::make_shared<Node>();
      put(*node, 0, static_cast<std::int8_t>(code));
      put(*node, 3, static_cast<std::int32_t>(code));
      codes.push_back(node);
    }
    return at->second;
  };
  const auto add_tensor = [&](const std::vector<int>& shape, int type, const NodePtr& data) {
    auto node = std::make_shared<Node>();
    put(*node, 1, static_cast<std::int8_t>(type));
    if (data) {
      auto buffer = std::make_shared<Node>();
      buffer->children.push_back({0, data});
      put(*node, 2, static_cast<std::uint32_t>(buffers.size()));
      buffers.push_back(buffer);
    }
    node->children.push_back({0, numbers(shape)});
    tensors.push_back(node);
  };
  const auto as_bytes = [](const NodePtr& node) {
    node->count = static_cast<std::uint32_t>(node->elements.size());
    return node;
  };
  const auto add_op = [&](int code, const std::vector<int>& inputs, int output, const NodePtr& options) {
    auto node = std::make_shared<Node>();
    put(*node, 0, static_cast<std::uint32_t>(index_of_code(code)));
    node->children.push_back({1, numbers(inputs)});
    node->children.push_back({2, numbers(std::vector<int>{output})});
    if (options) node->children.push_back({4, options});
    ops.push_back(node);
  };
  std::vector<std::pair<int, std::vector<std::uint16_t>>> widened;
  for (std::size_t i = 0; i < graph.tensors.size(); ++i) {
    const NetTensor& t = graph.tensors[i];
    if (!t.integers.empty()) {
      add_tensor(t.shape, 2, as_bytes(numbers(t.integers)));
    } else if (t.constant && halves) {
      std::vector<std::uint16_t> values(t.numbers.size());
      std::transform(t.numbers.begin(), t.numbers.end(), values.begin(), half_of);
      widened.emplace_back(static_cast<int>(i), std::move(values));
      add_tensor(t.shape, 0, nullptr);
    } else {
      add_tensor(t.shape, 0, t.constant ? as_bytes(numbers(t.numbers)) : nullptr);
    }
  }
  for (const auto& [tensor, values] : widened) {
    add_op(6, {static_cast<int>(tensors.size())}, tensor, nullptr);
    add_tensor(graph.tensors[static_cast<std::size_t>(tensor)].shape, 1, as_bytes(numbers(values)));
  }
  for (const NetOp& op : graph.ops) add_op(code_of(op.kind), op.inputs, op.output, options_of(op));
  auto subgraph = std::make_shared<Node>();
  subgraph->children = {
      {0, tables(tensors)}, {1, numbers(std::vector<int>{graph.input})}, {2, numbers(graph.outputs)}, {3, tables(ops)}};
  auto model = std::make_shared<Node>();
  put(*model, 0, std::uint32_t{3});
  model->children = {{1, tables(codes)}, {2, tables({subgraph})}, {4, tables(buffers)}};
  return Writer().write(model);
}

}  // namespace dubsar
