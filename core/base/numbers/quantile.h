#pragma once
// Ranks of measured values.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace dubsar {

/// The value below or at which a share p, 0..1, of them are (by rank); 0 of none.
inline double quantile(std::vector<double> values, double p) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(
      std::clamp(std::ceil(p * static_cast<double>(values.size())) - 1.0, 0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace dubsar
