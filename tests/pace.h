#pragma once
// How fast this machine is just now: figures in milliseconds are of one machine, and tests run on others, some of them
// busy.

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/base/system/clock.h"

namespace dubsar::testing {

/// Processor seconds of one thread for a fixed piece of work like a network's layer: products of matrices of floats
/// that stay in the nearest cache, and a pass over 8 MiB that do not. It touches no code of dubsar but its clock.
inline double yardstick_seconds() {
  constexpr std::size_t kSide = 64, kProducts = 15;
  std::vector<float> a(kSide * kSide, 0.5f), b(kSide * kSide, 0.25f), c(kSide * kSide);
  std::vector<float> far(2 << 20, 1.0f);
  const double before = process_cpu_seconds();
  for (std::size_t repeat = 0; repeat < kProducts; ++repeat)
    for (std::size_t i = 0; i < kSide; ++i)
      for (std::size_t k = 0; k < kSide; ++k) {
        const float factor = a[i * kSide + k];
        for (std::size_t j = 0; j < kSide; ++j) c[i * kSide + j] += factor * b[k * kSide + j];
      }
  for (float& value : far) value = 0.5f * value + c[7];
  const double took = process_cpu_seconds() - before;
  // What was computed is used, so that it is computed.
  return far.back() > -1.0f ? took : 0.0;
}

/// How many times longer than on the machine of the figures (two threads of an EPYC, -O1, as tests are compiled) work
/// takes at this moment; never below 1: a faster machine makes no bound stricter.
inline double slowness() {
  constexpr double kThere = 0.0022;
  std::array<double, 9> took{};
  for (double& each : took) each = yardstick_seconds();
  std::sort(took.begin(), took.end());
  return std::max(1.0, took[took.size() / 2] / kThere);
}

}  // namespace dubsar::testing
