#include "core/mesh/fans.h"

#include <algorithm>

namespace dubsar {

std::uint32_t Fans::find() {
  const auto count = static_cast<std::uint32_t>(corners_.size());
  sets_.reset(count);
  starts_.clear();
  for (std::uint32_t i = 0; i < count; ++i) starts_.emplace_back(corners_[i].next, i);
  std::sort(starts_.begin(), starts_.end());
  met_.assign(count, false);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t side = corners_[i].previous;
    const auto start = std::lower_bound(starts_.begin(), starts_.end(), std::pair(side, 0u));
    if (start == starts_.end() || start->first != side) continue;
    sets_.join(i, start->second);
    met_[static_cast<std::size_t>(start - starts_.begin())] = true;
  }
  // Where several corners start with a side that another ends with, all of them are neighbours of that one.
  for (std::size_t s = 1; s < count; ++s) {
    if (starts_[s].first != starts_[s - 1].first || !met_[s - 1]) continue;
    sets_.join(starts_[s - 1].second, starts_[s].second);
    met_[s] = true;
  }
  fan_.resize(count);
  std::uint32_t fans = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t first = sets_.root(i);
    fan_[i] = first == i ? fans++ : fan_[first];  // roots are the smallest of their set, so they come first
  }
  return fans;
}

}  // namespace dubsar
