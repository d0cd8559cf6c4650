#pragma once
// A few numbers in rising order, each once, with how often it was there: without a branch that could be guessed wrong.

#include <cstddef>
#include <cstdint>

namespace dubsar {

inline constexpr std::size_t kMergedIds = 16;

/// Of `ids`, `count` at most kMergedIds; those behind must be 0xFFFFFFFF. Writes id | min(times, 3) << 30 for each
/// different one, rising, and returns how many. `out` has room for kMergedIds. Ids are below 2^30.
std::size_t merge_ids(const std::uint32_t* ids, std::size_t count, std::uint32_t* out);

}  // namespace dubsar
