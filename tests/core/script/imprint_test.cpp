// The imprint's own figures: what was pressed is measured, whatever the direction.

#include "core/script/imprint/imprint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace dubsar {
namespace {

/// Depth of a wedge by its definition (docs/edition.md, written anew): head plane, two flanks.
double pressed(double x, double y, double angle, double width, double depth, double back, double front) {
  const double a = std::cos(angle) * x + std::sin(angle) * y, b = std::cos(angle) * y - std::sin(angle) * x;
  const double head = depth * (1.0 + a / back);
  const double flank = depth * (1.0 - a / front) - std::abs(b) * depth * (1.0 + back / front) / (0.5 * width);
  return std::max(0.0, std::min(head, flank));
}

DepthSamples samples_of(double angle, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  DepthSamples out;
  for (int y = -18; y <= 18; ++y)
    for (int x = -18; x <= 18; ++x) {
      out.x.push_back(static_cast<float>(x / 8.0));
      out.y.push_back(static_cast<float>(y / 8.0));
      out.depth.push_back(static_cast<float>(pressed(x / 8.0 - 0.1, y / 8.0 + 0.07, angle, 1.1, 0.5, 0.3, 1.1) +
                                             noise * normal(random)));
      out.weight.push_back(1.0f);
      out.level.push_back(0.0f);
      out.others.push_back(0.0f);
    }
  out.area = 1.0f / 64.0f;
  return out;
}

TEST(Imprint, AWedgeIsMeasuredInEveryDirection) {
  for (int k = 0; k < 12; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 12.0 + 0.11;
    const DepthSamples samples = samples_of(angle, 0.02, static_cast<unsigned>(k));
    const FitOptions options;
    ImprintStart best;
    best.energy = 1e30;
    for (ImprintStart start : imprint_starts(samples, {0.5, 0.0}, 0.0, 0.0, 24, options)) {
      start.energy = fit_imprint(start.imprint, samples, {0.5, 0.0}, options);
      if (start.energy < best.energy) best = start;
    }
    const Imprint& i = best.imprint;
    EXPECT_LT(std::abs(std::remainder(i.p[Imprint::kAngle] - angle, 2.0 * std::numbers::pi)), 0.03)
        << "direction " << k;
    EXPECT_NEAR(i.width(), 1.1, 0.06) << "direction " << k;
    EXPECT_NEAR(i.depth(), 0.5, 0.03) << "direction " << k;
    EXPECT_NEAR(i.p[Imprint::kX], 0.1, 0.03) << "direction " << k;
    EXPECT_NEAR(i.p[Imprint::kY], -0.07, 0.03) << "direction " << k;
  }
}

TEST(Imprint, WhatOthersExplainGainsNothing) {
  DepthSamples samples = samples_of(0.4, 0.0, 1);
  samples.others = samples.depth;
  EXPECT_NEAR(empty_energy(samples, {}), 0.0, 1e-12);
}

}  // namespace
}  // namespace dubsar
