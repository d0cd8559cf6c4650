#pragma once
// The sign code of the paper: octets of signs as ranks of a static table (paper_code.md).

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/extract/bit_volume.h"

namespace dubsar {

/// Lattices above the finest: as many as halve the shortest side to one cell, at most 6.
int paper_levels(const Dims& dims);

/// One chunk for the signs of the coarsest lattice, then one for each finer lattice. Lossless: where a surface hides
/// between coarse points, its cells are listed. One thread.
std::vector<std::string> encode_signs_as_paper(const BitVolume& signs);

/// The points of spacing 2^level; chunks of finer lattices may be missing. kBadData: wrong number of chunks, bytes that
/// encode_signs_as_paper() did not write; kTryAgain: memory. Visits no more cells than the volume has and no more
/// octets than the bytes can hold.
Result<BitVolume> decode_signs_as_paper(std::span<const std::string_view> chunks, const Dims& dims, int level = 0);

/// Bytes that decoding takes.
std::uint64_t paper_sign_memory(const Dims& dims);

}  // namespace dubsar
