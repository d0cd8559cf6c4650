#include "core/relief/curvature/shape_class.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/result.h"
#include "core/base/system/parallel.h"
#include "core/relief/curvature/shape_lanes.h"

namespace dubsar {

std::uint8_t shape_class(float k_min, float k_max) noexcept {
  if (!std::isfinite(k_min) || !std::isfinite(k_max)) return 0;
  if (k_min > k_max) std::swap(k_min, k_max);
  const double low = static_cast<double>(k_min), high = static_cast<double>(k_max);
  // The step is round(2 log2 of the curvedness over the smallest): that of the square lies between 2^(step -+ 1/2).
  constexpr double kScale = 1.0 / (double{kSmallestCurvedness} * double{kSmallestCurvedness});
  int step = 0;
  const double part = std::frexp(kScale * (low * low + high * high), &step);
  if (part < 0.7071067811865476) --step;
  if (part == 0.0 || step < 0) return 0;
  // The kind is round((atan2(low, high) + 135 degrees) / 22.5): how many of the angles between kinds lie below.
  int shape = 0;
  for (std::size_t j = 0; j < kShapeCosine.size(); ++j) shape += low * kShapeCosine[j] >= high * kShapeSine[j] ? 1 : 0;
  return static_cast<std::uint8_t>(1 + kShapes * std::min(step, 13) + shape);
}

std::vector<std::uint8_t> shape_classes(std::span<const float> k_min, std::span<const float> k_max) {
  DUBSAR_CHECK(k_min.size() == k_max.size());
  std::vector<std::uint8_t> classes(k_min.size());
  parallel_chunks(static_cast<std::int64_t>(k_min.size()), 16384, [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    const std::size_t done = shape_class_lanes(k_min.data() + first, k_max.data() + first, count, &classes[first]);
    for (std::size_t v = first + done; v < first + count; ++v) classes[v] = shape_class(k_min[v], k_max[v]);
  });
  return classes;
}

}  // namespace dubsar
