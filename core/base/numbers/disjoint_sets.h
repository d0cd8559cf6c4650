#pragma once
// Union-find: items that are joined pair by pair, and the set that each is in.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace dubsar {

/// Items 0, 1, ... below 2^32. The root of a set is its smallest item, whatever the order of joining.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) { reset(count); }

  /// `count` sets of one item each.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t root(std::uint32_t item) noexcept {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  /// False: they were in one set already.
  bool join(std::uint32_t a, std::uint32_t b) noexcept {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The same for joins by several threads at once: after all of them the roots are those of DisjointSets, whatever the
/// order was.
class ConcurrentSets {
 public:
  explicit ConcurrentSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  /// Also between joins of other threads, but then only of the moment.
  std::uint32_t root(std::uint32_t item) noexcept {
    for (;;) {
      const std::uint32_t up = at(item).load(std::memory_order_relaxed);
      if (up == item) return item;
      const std::uint32_t above = at(up).load(std::memory_order_relaxed);
      if (above != up) at(item).store(above, std::memory_order_relaxed);  // a shorter way; never one down
      item = up;
    }
  }
  void join(std::uint32_t a, std::uint32_t b) noexcept {
    for (;;) {
      a = root(a);
      b = root(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t expected = a;  // hang the larger root below the smaller, unless somebody was faster
      if (at(a).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
    }
  }

 private:
  std::atomic_ref<std::uint32_t> at(std::uint32_t item) noexcept { return std::atomic_ref(parent_[item]); }
  std::vector<std::uint32_t> parent_;
};

}  // namespace dubsar
