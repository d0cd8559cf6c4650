#pragma once
// How the vertices of fill patches are known, as bytes (docs/exa.md, "Evidence").

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// True when any patch says how its vertices are known.
bool has_patch_evidence(const std::vector<FillPatch>& patches);

/// One chunk. Lossless.
std::vector<std::string> encode_patch_evidence(const std::vector<FillPatch>& patches);
/// Fills the evidence of patches that are there already. kBadData: not one chunk.
Result<void> decode_patch_evidence(std::span<const std::string_view> chunks, std::vector<FillPatch>& patches);

}  // namespace dubsar
