#include "core/mesh/fans.h"

#include <algorithm>

namespace dubsar {

/// Whether a walk from the first corner, forth and back, comes by all of them, as it does nearly everywhere. False also
/// where they are many.
bool Fans::is_one() const {
  constexpr std::size_t kMost = 12;  // more are sorted faster
  const std::size_t count = corners_.size();
  if (count == 0 || count > kMost) return false;
  std::uint32_t met = 1;
  const auto walk = [&](auto end, auto begin) {  // from a corner's `end` to the corner that has it as its `begin`
    for (std::size_t at = 0, next = 0; next < count;) {
      for (next = 0; next < count; ++next)
        if ((met >> next & 1) == 0 && corners_[next].*begin == corners_[at].*end) break;
      if (next == count) return;
      met |= 1u << next;
      at = next;
    }
  };
  walk(&Corner::next, &Corner::previous);
  walk(&Corner::previous, &Corner::next);
  return met == (1u << count) - 1;
}

std::uint32_t Fans::find() {
  const auto count = static_cast<std::uint32_t>(corners_.size());
  if (is_one()) {
    fan_.assign(count, 0);
    return 1;
  }
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
