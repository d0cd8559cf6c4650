#pragma once
// A list as a set: rising, each value once.

#include <algorithm>
#include <vector>

namespace dubsar {

/// Sorts `list` and leaves one of each; O(n log n), without allocation.
template <class T>
void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace dubsar
