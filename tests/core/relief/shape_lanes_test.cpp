#include "core/relief/curvature/shape_lanes.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/relief/curvature/shape_class.h"

namespace dubsar {
namespace {

TEST(ShapeLanes, GiveTheClassesOfOneAtATime) {
  std::mt19937 random(5);
  std::vector<float> low, high;
  const float special[] = {0.0f,
                           -0.0f,
                           kSmallestCurvedness,
                           -kSmallestCurvedness,
                           1e-30f,
                           1e30f,
                           1e-42f,
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN()};
  for (const float a : special)
    for (const float b : special) low.push_back(a), high.push_back(b);
  for (int i = 0; i < 100001; ++i) {
    const double size = std::exp2(double(random() % 4096) / 256.0 - 10.0), angle = double(random() % 3600) / 573.0;
    low.push_back(static_cast<float>(size * std::cos(angle)));
    high.push_back(static_cast<float>(size * std::sin(angle)));
  }
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const std::vector<std::uint8_t> found = shape_classes(low, high);
    for (std::size_t v = 0; v < low.size(); ++v)
      ASSERT_EQ(found[v], shape_class(low[v], high[v])) << low[v] << ' ' << high[v] << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace
}  // namespace dubsar
