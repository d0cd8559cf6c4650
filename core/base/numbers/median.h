#pragma once
// The middle of some values: what most of them agree on, whatever a few say.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dubsar {

/// The upper of both middle values of an even number; 0 of none.
template <class T>
T median(std::vector<T> values) {
  if (values.empty()) return T{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace dubsar
