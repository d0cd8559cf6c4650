#pragma once
// The sign code (paper section 3.2): signs on lattices of spacing 32, 16, ... 1. A cell that no surface enters is
// dropped with everything inside it; only points all of whose coarser cells are active are coded.
//
// Per level: seven phases (cell centres, three kinds of face points, three kinds of edge points), so that the points
// of a phase see neighbours of earlier phases on both sides; then one flag for each child cell whose corners agree:
// does it hide a surface? Without the flags the code would lose small features. Bits go through adaptive binary
// models chosen by the known neighbours.

#include <string>
#include <string_view>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/bit_volume.h"

namespace dubsar {

/// Lossless. Cost: one pass over the bits to find active cells (all threads), then about 1.4 coded bits per vertex on
/// one thread. kCancelled.
Result<std::string> encode_signs(const BitVolume& signs, Progress& progress);

/// `dims` must have passed check_dims. kBadData for anything that is not exactly one encoded volume; kTryAgain when the
/// volume does not fit in memory. Memory: the volume's bits and the list of active cells.
Result<BitVolume> decode_signs(std::string_view bytes, const Dims& dims, Progress& progress);

}  // namespace dubsar
