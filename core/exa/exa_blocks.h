#pragma once
// Names that writers and readers of the blocks share.

#include <array>
#include <cstdint>

namespace dubsar {

inline constexpr std::uint16_t kCodec = 0;
inline constexpr std::array<const char*, 3> kSignBlocks{"SIG0", "SIG1", "SIG2"};  ///< by level

}  // namespace dubsar
