#pragma once
// Fill patches as bytes. Few and small, so they are stored plainly.
//
//   count 4; then per patch: part 1, reverse part 1, zero 2, extra vertices 4, triangles 4, vertices 12 each,
//   triangles 12 each

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/parts/surface_model.h"

namespace dubsar {

std::string encode_patches(const std::vector<FillPatch>& patches);
/// kBadData: counts beyond the bytes that are there, ids of vertices that do not exist, positions that are not finite.
Result<std::vector<FillPatch>> decode_patches(std::string_view bytes, std::int64_t vertex_count);
/// The same checks on a model in memory.
Result<void> check_patches(const std::vector<FillPatch>& patches, std::int64_t vertex_count);

}  // namespace dubsar
