#pragma once
// The words of a binary glTF file (glTF 2.0, section 4.4).

#include <cstdint>

namespace dubsar {

inline constexpr std::uint32_t kGlbMagic = 0x46546C67;      ///< "glTF"
inline constexpr std::uint32_t kGlbJsonChunk = 0x4E4F534A;  ///< "JSON"
inline constexpr std::uint32_t kGlbBinChunk = 0x004E4942;   ///< "BIN"

}  // namespace dubsar
