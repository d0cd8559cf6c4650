#pragma once
// Words of bits that several threads read and write, each its own bits.

#include <cstdint>

namespace dubsar {

inline std::uint64_t load_shared(const std::uint64_t* word) noexcept { return __atomic_load_n(word, __ATOMIC_RELAXED); }

/// Sets bits. `shared`: other threads may set others of the same word at the same time; if not, they may only read.
inline void or_words(std::uint64_t* word, std::uint64_t bits, bool shared) noexcept {
  if (shared)
    __atomic_fetch_or(word, bits, __ATOMIC_RELAXED);
  else
    __atomic_store_n(word, load_shared(word) | bits, __ATOMIC_RELAXED);
}

}  // namespace dubsar
