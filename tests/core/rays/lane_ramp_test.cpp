#include "core/rays/lane_ramp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace dubsar {
namespace {
using kernels::kLanes;

/// Long rays through an ellipse, and noise upon them in every second lane; 0 beside it.
std::vector<float> chords(std::int64_t bins) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  std::vector<float> row(static_cast<std::size_t>(bins * kLanes));
  const double middle = 0.45 * double(bins), half = 0.4 * double(bins);
  for (std::int64_t u = 0; u < bins; ++u)
    for (std::int64_t lane = 0; lane < kLanes; ++lane) {
      const double at = (double(u) - middle) / half;
      if (std::abs(at) < 1.0)
        row[static_cast<std::size_t>(u * kLanes + lane)] =
            static_cast<float>(0.5 * double(bins) * std::sqrt(1.0 - at * at)) + (lane % 2 == 1 ? normal(random) : 0.0F);
    }
  return row;
}

/// [Kak 1988], eq. 61, by its sum.
double expected(const std::vector<float>& row, std::int64_t bins, std::int64_t u, std::int64_t lane) {
  double sum = 0.25 * row[static_cast<std::size_t>(u * kLanes + lane)];
  for (std::int64_t v = (u + 1) % 2; v < bins; v += 2)
    sum -= row[static_cast<std::size_t>(v * kLanes + lane)] /
           (std::numbers::pi * std::numbers::pi * double(u - v) * double(u - v));
  return sum;
}

TEST(LaneRamp, IsThatOfItsFormula) {
  for (const auto& [bins, error] : {std::pair<std::int64_t, double>{101, 2e-5}, {600, 5e-4}, {2101, 5e-4}}) {
    const std::vector<float> in = chords(bins);
    std::vector<float> out(in.size());
    LaneRamp(bins).apply(in.data(), out.data());
    for (std::int64_t u = 0; u < bins; ++u)
      for (const std::int64_t lane : {0, 7, 14})
        ASSERT_NEAR(out[static_cast<std::size_t>(u * kLanes + lane)], expected(in, bins, u, lane), error)
            << bins << " " << u << " " << lane;
  }
}

}  // namespace
}  // namespace dubsar
