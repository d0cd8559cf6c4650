#pragma once
// Fits the weights of a network of signs by gradient descent (Kingma and Ba 2015) on the bits that the points take, and
// rounds them to those of a file's version (core/exa/signs/sign_model.h).

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/exa/signs/sign_model.h"
#include "tests/bench/training/sign_samples.h"

namespace dubsar {

struct SignTraining {
  std::size_t units = 64;  ///< 16 or 64
  int epochs = 10;
  double rate = 0.003;
  unsigned seed = 5;
};

/// Seven phases, one after another on all threads; deterministic for any number of them on one machine, not between
/// compilers (floating point). About 1 us a sample, epoch and core with 64 units.
std::array<SignWeights, 7> train_signs(const SignSamples& samples, const SignTraining& training);

/// Bits that the samples take with fixed probabilities of the rounded weights.
double sign_bits(const SignSamples& samples, const std::array<SignWeights, 7>& weights, std::size_t units);

/// The table as core/exa/signs/sign_weights*.inc hold it.
std::string sign_weights_text(const std::array<SignWeights, 7>& weights, std::size_t units, std::string_view name);

}  // namespace dubsar
