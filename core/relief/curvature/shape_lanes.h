#pragma once
// shape_class() of many vertices at once.

#include <array>
#include <cstddef>
#include <cstdint>

namespace dubsar {

/// Cosine and sine of the angles between the kinds of shape: -123.75 + 22.5 j degrees, j = 0..7.
inline constexpr std::array<double, 8> kShapeCosine{-0.555570233019602, -0.195090322016128, 0.19509032201612825,
                                                    0.5555702330196023, 0.8314696123025452, 0.9807852804032304,
                                                    0.9807852804032304, 0.8314696123025452};
inline constexpr std::array<double, 8> kShapeSine{-0.8314696123025452, -0.9807852804032304, -0.9807852804032304,
                                                  -0.8314696123025452, -0.5555702330196022, -0.1950903220161282,
                                                  0.1950903220161283,  0.5555702330196022};

/// The same as shape_class(), bit for bit, of the first vertices; returns how many: all but fewer than a vector.
std::size_t shape_class_lanes(const float* k_min, const float* k_max, std::size_t count,
                              std::uint8_t* classes) noexcept;

}  // namespace dubsar
