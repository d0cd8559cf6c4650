// The networks for faces and hands, read by OpenCV as they were converted.

#include "input/tracking/vision/network.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/files/input_file.h"
#include "tests/core/volume/temp_folder.h"
#include "tests/input/tracking/vision/vision_data.h"

namespace dubsar {
namespace {

using NetworkFiles = testing_tools::TempFolder;

TEST_F(NetworkFiles, ThatAreNotTheKnownOnesAreRefusedBeforeOpenCvSeesThem) {
  EXPECT_EQ(Network::read(folder(), kFaceModel).error().kind, ErrorKind::kNoInput);
  const auto write = [&](const std::string& bytes) { std::ofstream(folder() / kFaceModel.name) << bytes; };
  write("no network");
  EXPECT_EQ(Network::read(folder(), kFaceModel).error().kind, ErrorKind::kBadData);
  const auto known = read_file_bytes(model_folder() / kFaceModel.name);
  if (!known) GTEST_SKIP() << kNoModels;
  for (const std::size_t at : {std::size_t{0}, known->size() / 2, known->size() - 1}) {
    std::string damaged(known->begin(), known->end());
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    write(damaged);
    const auto read = Network::read(folder(), kFaceModel);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("checksum"), std::string::npos) << read.error().message;
  }
}

/// What plain loops over the operations of the original .tflite file give for the picture below, to 2e-4 of the
/// largest: how many numbers, the mean of their magnitudes, and those at 0, 1/3, 2/3 and the end.
struct KnownOutput {
  std::size_t count;
  double mean;
  std::array<double, 4> at;
};
struct KnownNetwork {
  ModelFile file;
  float low;  ///< of the picture's values, up to 1
  std::vector<KnownOutput> outputs;
};

class Networks : public testing::TestWithParam<KnownNetwork> {};

TEST_P(Networks, GiveWhatPlainLoopsOverTheOriginalGive) {
  const KnownNetwork& known = GetParam();
  if (!std::filesystem::exists(model_folder() / known.file.name)) GTEST_SKIP() << kNoModels;
  auto network = Network::read(model_folder(), known.file);
  ASSERT_TRUE(network) << network.error().message;
  const auto side = static_cast<std::size_t>(known.file.size_px);
  std::vector<float> planes(3 * side * side);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::uint32_t mixed = static_cast<std::uint32_t>(i) * 2654435761u;
    planes[i] = known.low + (1.0f - known.low) * static_cast<float>(mixed >> 8 & 0xffff) / 65535.0f;
  }
  std::vector<std::vector<float>> outputs;
  ASSERT_TRUE(network->run(planes, outputs));
  ASSERT_EQ(outputs.size(), known.outputs.size());
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const std::vector<float>& found = outputs[k];
    const KnownOutput& expected = known.outputs[k];
    ASSERT_EQ(found.size(), expected.count);
    double sum = 0.0, largest = 0.0;
    for (const float value : found) {
      sum += std::abs(value);
      largest = std::max<double>(largest, std::abs(value));
    }
    EXPECT_NEAR(sum / static_cast<double>(found.size()), expected.mean, 2e-4 * expected.mean);
    const std::array<std::size_t, 4> places{0, found.size() / 3, 2 * found.size() / 3, found.size() - 1};
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(found[places[i]], expected.at[i], 2e-4 * largest);
  }
}
INSTANTIATE_TEST_SUITE_P(
    All, Networks,
    testing::Values(KnownNetwork{kFaceModel,
                                 -1.0f,
                                 {{14336, 12.537, {0.451372, 1.27738, -10.9748, -9.45105}},
                                  {896, 3.78533, {-4.48297, -2.98074, -2.7185, -39.9439}}}},
                    KnownNetwork{kPalmModel,
                                 0.0f,
                                 {{36288, 10.7024, {5.11962, -5.17407, 2.47939, -9.32084}},
                                  {2016, 9.8428, {-10.7201, -6.54904, -9.93764, -15.563}}}},
                    KnownNetwork{kHandModel,
                                 0.0f,
                                 {{63, 68.6642, {110.835, 109.893, 117.379, -3.20838}},
                                  {1, 0.00196987, {0.00196987, 0.00196987, 0.00196987, 0.00196987}},
                                  {1, 0.583857, {0.583857, 0.583857, 0.583857, 0.583857}},
                                  {63, 0.0117195, {-0.0114381, -0.00699293, 0.00364029, 0.00937787}}}}),
    [](const auto& known) { return std::string(known.param.file.name.substr(0, known.param.file.name.find('.'))); });

}  // namespace
}  // namespace dubsar
