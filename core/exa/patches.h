#pragma once
// Fill patches as bytes (docs/exa.md, "Fill patches").

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/parts/surface_model.h"

namespace dubsar {

inline constexpr double kPatchStep = 1.0 / 1024.0;  ///< grid steps

/// Rounds the vertices of the patches to kPatchStep, which is what EXA stores compactly. Twice is the same as once.
void settle_patches(std::vector<FillPatch>& patches);

/// One chunk. Lossless.
std::vector<std::string> encode_patches(const std::vector<FillPatch>& patches, std::int64_t vertex_count);
/// kBadData: counts beyond what the bytes can hold, ids of vertices that do not exist, positions that are not finite.
Result<std::vector<FillPatch>> decode_patches(std::span<const std::string_view> chunks, std::int64_t vertex_count);
/// The same checks on a model in memory.
Result<void> check_patches(const std::vector<FillPatch>& patches, std::int64_t vertex_count);

}  // namespace dubsar
