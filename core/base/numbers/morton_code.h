#pragma once
// Places in the order of a curve that fills space, so that neighbours in the order are neighbours in space.

#include <cstdint>
#include <glm/vec3.hpp>

namespace dubsar {

/// Bit i to bit 3 i, for the lower 21 bits.
inline std::uint64_t every_third_bit(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffULL;
  x = (x | x << 16) & 0x1f0000ff0000ffULL;
  x = (x | x << 8) & 0x100f00f00f00f00fULL;
  x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

/// Morton's code of a cell, 63 bits: those of x, y and z in turn, x lowest. Coordinates are cut down to whole numbers,
/// 0 to 2^21 - 1.
inline std::uint64_t morton_code(const glm::vec3& cell) {
  return every_third_bit(static_cast<std::uint64_t>(cell.x)) |
         every_third_bit(static_cast<std::uint64_t>(cell.y)) << 1 |
         every_third_bit(static_cast<std::uint64_t>(cell.z)) << 2;
}

}  // namespace dubsar
