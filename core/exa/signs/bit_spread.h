#pragma once
// Words of signs: between a row of points and the row of twice as many on the next finer lattice, and how many are 1.

#include <cstdint>

namespace dubsar {

/// Bit i to bit 2 i, for the lower 32 bits.
inline std::uint64_t spread_bits(std::uint64_t w) {
  w &= 0xFFFFFFFFu;
  w = (w | w << 16) & 0x0000FFFF0000FFFFu;
  w = (w | w << 8) & 0x00FF00FF00FF00FFu;
  w = (w | w << 4) & 0x0F0F0F0F0F0F0F0Fu;
  w = (w | w << 2) & 0x3333333333333333u;
  return (w | w << 1) & 0x5555555555555555u;
}

/// Bit 2 i to bit i.
inline std::uint64_t even_bits(std::uint64_t w) {
  w &= 0x5555555555555555u;
  w = (w | w >> 1) & 0x3333333333333333u;
  w = (w | w >> 2) & 0x0F0F0F0F0F0F0F0Fu;
  w = (w | w >> 4) & 0x00FF00FF00FF00FFu;
  w = (w | w >> 8) & 0x0000FFFF0000FFFFu;
  return (w | w >> 16) & 0xFFFFFFFFu;
}

/// How many bits are 1, without an instruction that not every processor has: then std::popcount is a call.
inline std::uint32_t count_ones_of(std::uint64_t w) {
  w -= w >> 1 & 0x5555555555555555u;
  w = (w & 0x3333333333333333u) + (w >> 2 & 0x3333333333333333u);
  return static_cast<std::uint32_t>(((w + (w >> 4)) & 0x0F0F0F0F0F0F0F0Fu) * 0x0101010101010101u >> 56);
}

}  // namespace dubsar
