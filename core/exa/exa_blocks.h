#pragma once
// Names that writers and readers of the blocks share.

#include <array>
#include <cstdint>

namespace dubsar {

inline constexpr std::uint16_t kCodec = 0;
inline constexpr std::array<const char*, 3> kSignBlocks{"SIG0", "SIG1", "SIG2"};  ///< by level

/// Grid steps from the origin beyond which no place of a file lies: grids end at 65535, and 1 / 1024 of such places,
/// summed over a patch, fit 64 bits.
inline constexpr float kFarthestPlace = 1e6F;

}  // namespace dubsar
