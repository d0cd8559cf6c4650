#include "core/relief/shape_class.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/result.h"

namespace dubsar {

std::uint8_t shape_class(float k_min, float k_max) noexcept {
  if (!std::isfinite(k_min) || !std::isfinite(k_max)) return 0;
  if (k_min > k_max) std::swap(k_min, k_max);
  const double low = static_cast<double>(k_min), high = static_cast<double>(k_max);
  const double curvedness = std::hypot(low, high);
  if (curvedness == 0.0) return 0;
  const double step = std::round(2.0 * std::log2(curvedness / static_cast<double>(kSmallestCurvedness)));
  if (step < 0.0) return 0;
  // k_min <= k_max keeps atan2 in [-135, 45] degrees; the clamp absorbs its rounding at both ends.
  const double phi_deg = std::atan2(low, high) * 57.29577951308232;
  const double shape = std::clamp(std::round((phi_deg + 135.0) / 22.5), 0.0, 8.0);
  return static_cast<std::uint8_t>(1 + kShapes * static_cast<int>(std::min(step, 13.0)) + static_cast<int>(shape));
}

std::vector<std::uint8_t> shape_classes(std::span<const float> k_min, std::span<const float> k_max) {
  DUBSAR_CHECK(k_min.size() == k_max.size());
  std::vector<std::uint8_t> classes(k_min.size());
  parallel_for(static_cast<std::int64_t>(k_min.size()), 16384, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    classes[v] = shape_class(k_min[v], k_max[v]);
  });
  return classes;
}

}  // namespace dubsar
