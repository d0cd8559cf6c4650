#pragma once
// CRC-32 of long runs of bytes by multiplication without carries (Gopal et al. 2009).

#include <cstddef>
#include <cstdint>

namespace dubsar {

/// The state of a reflected CRC-32 register as 16 bytes that take the place of the bytes folded: the register after
/// them is the one after these 16, started from 0.
struct FoldedCrc {
  std::uint8_t bytes[16];
};

/// Folds the first `size` bytes, a multiple of 64 and not 0, into 16. `state`: the register before. False: this machine
/// multiplies no faster than a table is read.
bool fold_crc(const std::uint8_t* from, std::size_t size, std::uint32_t state, FoldedCrc& folded) noexcept;

}  // namespace dubsar
