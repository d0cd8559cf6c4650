// Model files and the networks made of them: a small file with every operation, damaged ones, and the real
// ones.

#include "input/tracking/vision/network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "core/base/files/input_file.h"
#include "input/tracking/vision/model_files.h"
#include "input/tracking/vision/tflite_file.h"
#include "tests/input/tracking/vision/small_nets.h"
#include "tests/input/tracking/vision/tflite_writer.h"
#include "tests/input/tracking/vision/vision_data.h"

namespace dubsar {
namespace {

/// Rows x columns x channels of numbers in `low` to `high`, and the same as planes.
struct Noise {
  std::vector<float> interleaved, planes;
  Noise(int rows, int columns, int channels, float low, float high) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> number(low, high);
    const auto pixels = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    interleaved.resize(pixels * static_cast<std::size_t>(channels));
    planes.resize(interleaved.size());
    for (std::size_t i = 0; i < interleaved.size(); ++i) {
      interleaved[i] = number(random);
      planes[i % static_cast<std::size_t>(channels) * pixels + i / static_cast<std::size_t>(channels)] = interleaved[i];
    }
  }
};

void expect_as_by_hand(const NetGraph& graph, float low, float high, double tolerance) {
  auto network = Network::build(graph, "test");
  ASSERT_TRUE(network) << network.error().message;
  const Noise noise(network->rows(), network->columns(), network->channels(), low, high);
  std::vector<std::vector<float>> outputs;
  ASSERT_TRUE(network->run(noise.planes, outputs));
  const auto expected = run_by_hand(graph, noise.interleaved);
  ASSERT_EQ(outputs.size(), expected.size());
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    ASSERT_EQ(outputs[i].size(), expected[i].size());
    double largest = 0.0, worst = 0.0;
    for (std::size_t k = 0; k < outputs[i].size(); ++k) {
      largest = std::max<double>(largest, std::abs(expected[i][k]));
      worst = std::max<double>(worst, std::abs(expected[i][k] - outputs[i][k]));
    }
    EXPECT_GT(largest, 0.0);
    EXPECT_LE(worst, tolerance * std::max(1.0, largest)) << "output " << i;
  }
}

TEST(Network, EveryOperationGivesWhatItsDefinitionSays) { expect_as_by_hand(tiny_net(), -2.0f, 2.0f, 1e-5); }

TEST(Network, ResizingByCornersAndByPixelStartsGivesWhatTheDefinitionSays) {
  for (const bool corners : {false, true}) {
    NetGraph graph = tiny_net();
    for (NetOp& op : graph.ops)
      if (op.kind == NetOpKind::kResizeBilinear) {
        op.half_pixel_centres = false;
        op.align_corners = corners;
      }
    expect_as_by_hand(graph, -2.0f, 2.0f, 1e-5);
  }
}

TEST(TfliteFile, WeightsOf16And32BitsGiveTheGraphThatWasWritten) {
  const NetGraph graph = tiny_net();
  for (const bool halves : {false, true}) {
    const auto read = read_tflite(write_tflite(graph, halves), "test");
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->ops.size(), graph.ops.size());
    EXPECT_EQ(read->input, graph.input);
    EXPECT_EQ(read->outputs, graph.outputs);
    for (std::size_t i = 0; i < graph.ops.size(); ++i) {
      const NetOp &a = graph.ops[i], &b = read->ops[i];
      EXPECT_EQ(a.kind, b.kind);
      EXPECT_EQ(a.inputs, b.inputs);
      EXPECT_EQ(a.output, b.output);
      EXPECT_EQ(a.same_padding, b.same_padding);
      EXPECT_EQ(a.stride_rows, b.stride_rows);
      EXPECT_EQ(a.filter_columns, b.filter_columns);
      EXPECT_EQ(a.activation, b.activation);
      EXPECT_EQ(a.half_pixel_centres, b.half_pixel_centres);
      EXPECT_EQ(a.axis, b.axis);
    }
    for (std::size_t i = 0; i < graph.tensors.size(); ++i) {
      EXPECT_EQ(read->tensors[i].shape, graph.tensors[i].shape);
      EXPECT_EQ(read->tensors[i].numbers, graph.tensors[i].numbers);
      EXPECT_EQ(read->tensors[i].integers, graph.tensors[i].integers);
    }
  }
}

TEST(TfliteFile, EveryTruncationIsRefused) {
  const std::vector<std::byte> bytes = write_tflite(tiny_net(), true);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // a copy of its own, so that a read beyond it is seen by the sanitizer
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const auto read = read_tflite(cut, "test");
    if (!read) {
      ASSERT_EQ(read.error().kind, ErrorKind::kBadData);
    } else {
      ASSERT_GE(size + 8, bytes.size()) << "only padding may be missing";
    }
  }
}

TEST(TfliteFile, FlippedBitsGiveASoundGraphOrBadData) {
  const std::vector<std::byte> bytes = write_tflite(tiny_net(), false);
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::vector<std::byte> damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
    const auto read = read_tflite(damaged, "test");
    if (read) {
      ASSERT_TRUE(check_graph(*read, "test"));
    } else {
      ASSERT_EQ(read.error().kind, ErrorKind::kBadData);
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);  // offsets, shapes and options; weights may be anything finite
}

TEST(TfliteFile, RandomBytesAreRefused) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> bytes(random() % 400);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() % (i % 2 == 0 ? 256 : 12));
    ASSERT_FALSE(read_tflite(bytes, "test"));
  }
}

TEST(NetGraph, ShapesThatDoNotFitAreRefused) {
  const NetGraph good = tiny_net();
  ASSERT_TRUE(check_graph(good, "test"));
  for (std::size_t tensor = 0; tensor < good.tensors.size(); ++tensor)
    for (std::size_t dimension = 0; dimension < good.tensors[tensor].shape.size(); ++dimension) {
      NetGraph bad = good;
      ++bad.tensors[tensor].shape[dimension];
      if (const int t = static_cast<int>(tensor); t == good.input && dimension == 1) continue;  // 8 rows also give 4
      EXPECT_FALSE(check_graph(bad, "test")) << "tensor " << tensor << " dimension " << dimension;
    }
  for (std::size_t op = 0; op < good.ops.size(); ++op) {
    NetGraph bad = good;
    bad.ops.erase(bad.ops.begin() + static_cast<std::ptrdiff_t>(op));
    EXPECT_FALSE(check_graph(bad, "test")) << "without operation " << op;
  }
}

TEST(NetGraph, AxesAndPaddingsThatAreNoneAreRefused) {
  const NetGraph good = tiny_net();
  for (std::size_t i = 0; i < good.ops.size(); ++i)
    for (const std::int32_t wrong : {-1157615616, 2147483647, -2147483647 - 1, 3}) {
      if (good.ops[i].inputs.size() < 2) continue;
      NetGraph bad = good;
      NetTensor& second = bad.tensors[static_cast<std::size_t>(bad.ops[i].inputs[1])];
      if (second.integers.empty()) continue;
      std::fill(second.integers.begin(), second.integers.end(), wrong);
      EXPECT_FALSE(check_graph(bad, "test")) << "operation " << i << " with " << wrong;
    }
}

TEST(Network, FilesThatAreNoNetworksAreRefusedInOneSentence) {
  EXPECT_EQ(Network::read("/nonexistent.tflite").error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(Network::read("/dev").error().kind, ErrorKind::kBadData);
}

class RealNetworks : public testing::TestWithParam<std::string_view> {};

TEST_P(RealNetworks, TheRealFileGivesWhatPlainLoopsGive) {
  const auto path = model_folder() / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << kNoModels;
  const auto bytes = read_file_bytes(path);
  ASSERT_TRUE(bytes);
  const auto graph = read_tflite(std::as_bytes(std::span(bytes->data(), bytes->size())), path.string());
  ASSERT_TRUE(graph) << graph.error().message;
  expect_as_by_hand(*graph, GetParam() == kFaceModel ? -1.0f : 0.0f, 1.0f, 2e-4);
}
INSTANTIATE_TEST_SUITE_P(All, RealNetworks, testing::Values(kFaceModel, kPalmModel, kHandModel),
                         [](const auto& file) { return std::string(file.param.substr(0, file.param.find('.'))); });

}  // namespace
}  // namespace dubsar
