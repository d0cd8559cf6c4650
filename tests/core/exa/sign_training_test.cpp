// The trainer of the sign networks: a short run learns, and writes tables like those that the format uses.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "core/exa/signs/sign_brick.h"
#include "core/exa/signs/topology.h"
#include "tests/bench/training/sign_trainer.h"

namespace dubsar {
namespace {

BitVolume bumpy(unsigned seed) {
  std::mt19937 random(seed);
  BitVolume signs(Dims{60, 50, 44});
  for (std::int64_t z = 0; z < 44; ++z)
    for (std::int64_t y = 0; y < 50; ++y)
      for (std::int64_t x = 0; x < 60; ++x)
        signs.set(x, y, z,
                  std::sin(.2 * double(x)) + std::sin(.17 * double(y)) + std::sin(.15 * double(z)) >
                      .1 * (double(random() % 1000) / 1000.0 - .5));
  return signs;
}

/// In a table: of each phase the weights of its taps, biases and out weights for each unit, and three biases.
std::size_t sign_weight_count(std::size_t units) {
  std::size_t count = 0;
  for (const int phase : kSignPhases) count += (sign_taps(phase).size() + 2) * units + 3;
  return count;
}

std::size_t numbers_behind(const std::string& text, const std::string& table) {
  const std::size_t start = text.find("{", text.find(table + "[]")), end = text.find("}", start);
  return static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(start),
                                             text.begin() + static_cast<std::ptrdiff_t>(end), ','));
}
std::string stored(const char* file) {
  std::ifstream in(std::string(DUBSAR_EXA_SOURCE) + "/" + file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(SignTraining, AShortRunLearnsWhatTheStoredNetworkKnowsInPart) {
  SignSamples samples, other;
  add_sign_samples(bumpy(1), samples);
  add_sign_samples(bumpy(2), other);
  std::size_t points = 0;
  for (const auto& phase : other) points += phase.size();
  ASSERT_GT(points, 5000u);
  SignTraining training;
  training.units = 16;
  training.epochs = 1;
  const double one = sign_bits(other, train_signs(samples, training), 16) / static_cast<double>(points);
  training.epochs = 6;
  const auto weights = train_signs(samples, training);
  const double six = sign_bits(other, weights, 16) / static_cast<double>(points);
  EXPECT_LT(one, 1.0) << "bits a point of a surface that was not trained on";
  EXPECT_LT(six, 0.8 * one);
  EXPECT_LT(six, 0.5);
}

TEST(SignTraining, SamplesAreThePointsThatTheEncoderCodes) {
  // The sum over the samples with the stored network is what the encoder writes, but for flags, refining and the end
  // of each chunk.
  const BitVolume signs = bumpy(3);
  SignSamples samples;
  add_sign_samples(signs, samples);
  SilentProgress progress;
  const SignCode code = encode_signs(signs, progress).value();
  std::size_t bytes = 0;
  for (const auto& level : code.bricks)
    for (const std::string& chunk : level) bytes += chunk.size();
  for (std::size_t i = 1; i < code.coarse.size(); ++i) bytes += code.coarse[i].size();
  const double bits = sign_bits(samples, SignModel::stored_weights(2), 64);
  EXPECT_NEAR(bits, 8.0 * static_cast<double>(bytes), 0.2 * bits);
}

TEST(SignTraining, TablesHaveTheFormOfTheStoredOnes) {
  SignSamples samples;
  add_sign_samples(bumpy(4), samples);
  for (auto& phase : samples) phase.resize(std::min<std::size_t>(phase.size(), 200));
  for (const std::size_t units : {std::size_t{16}, std::size_t{64}}) {
    SignTraining training;
    training.units = units;
    training.epochs = 1;
    const std::string text = sign_weights_text(train_signs(samples, training), units, "Test");
    EXPECT_EQ(numbers_behind(text, "kSignWeightsTest"), sign_weight_count(units));
  }
  const std::string narrow = stored("sign_weights.inc"), wide = stored("sign_weights_wide.inc");
  EXPECT_EQ(numbers_behind(narrow, "kSignWeightsScan"), sign_weight_count(16));
  EXPECT_EQ(numbers_behind(narrow, "kSignWeightsSmooth"), sign_weight_count(16));
  EXPECT_EQ(numbers_behind(wide, "kSignWeightsWide"), sign_weight_count(64));
  EXPECT_EQ(sign_weights_text(SignModel::stored_weights(2), 64, "Wide"), wide);
}

}  // namespace
}  // namespace dubsar
