#pragma once
// Threads: loops whose results do not depend on the number of threads.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

namespace dubsar {

/// Threads used by the loops below; 0 means all cores. Call from the main thread, between loops.
void set_thread_count(int threads);
int thread_count() noexcept;

/// Calls body(begin, end) for chunks of at most `grain` items that together are [0, count), on all threads, in no
/// order. The first exception thrown by a body is thrown again here after the loop. Chunks do not depend on the
/// number of threads, so per-chunk results combined in order are deterministic.
void parallel_chunks(std::int64_t count, std::int64_t grain,
                     const std::function<void(std::int64_t begin, std::int64_t end)>& body);

/// Same, one item at a time: body(i).
template <class Body>
void parallel_for(std::int64_t count, std::int64_t grain, const Body& body) {
  parallel_chunks(count, grain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) body(i);
  });
}

/// Reduces fixed chunks in order: result = combine(...combine(combine(init, f(chunk 0)), f(chunk 1))...). The same
/// bits for any number of threads, also for floating point.
template <class T, class Map, class Combine>
T parallel_reduce(std::int64_t count, std::int64_t grain, T init, const Map& map, const Combine& combine) {
  static_assert(!std::is_same_v<T, bool>, "std::vector<bool> cannot be written by several threads");
  const std::int64_t step = std::max<std::int64_t>(grain, 1);
  std::vector<T> partial(static_cast<std::size_t>((count + step - 1) / step), init);
  parallel_chunks(count, step, [&](std::int64_t begin, std::int64_t end) {
    partial[static_cast<std::size_t>(begin / step)] = map(begin, end);
  });
  for (T& part : partial) init = combine(std::move(init), std::move(part));
  return init;
}

/// Replaces counts by their exclusive prefix sum in place and returns the total.
std::int64_t exclusive_scan(std::span<std::int64_t> counts);

}  // namespace dubsar
