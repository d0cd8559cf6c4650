#pragma once
// The sign code of the paper, for comparison: octets of signs as ranks of a static table (docs/exa.md, "The paper's
// profile"). Not used in files.

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/extract/bit_volume.h"

namespace dubsar {

/// Lossless: where a surface hides between coarse points, its cells are listed. One thread.
std::string encode_signs_as_paper(const BitVolume& signs);
/// kBadData: bytes that encode_signs_as_paper() did not write.
Result<BitVolume> decode_signs_as_paper(std::string_view bytes, const Dims& dims);

}  // namespace dubsar
