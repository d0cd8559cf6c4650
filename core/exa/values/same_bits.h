#pragma once
// Equality of places as they are stored: a NaN equals itself, 0 and -0 differ.

#include <array>
#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>

namespace dubsar {

inline bool same_bits(const glm::vec3& a, const glm::vec3& b) {
  return std::bit_cast<std::array<std::uint32_t, 3>>(a) == std::bit_cast<std::array<std::uint32_t, 3>>(b);
}

}  // namespace dubsar
