#pragma once
// Colours of vertices in the ranges that programs write: 0 to 1, 0 to 255, 0 to 65535.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace dubsar {

/// One range for all of them, after the largest: fractions of 1, or bytes (larger than 1 and whole, or far larger);
/// of integers bytes or, where one is above 255, 16 bits. NaN counts as 0, what is outside the range as its end.
std::vector<std::array<std::uint8_t, 3>> color_bytes(std::span<const glm::vec3> colors, bool integers);

}  // namespace dubsar
