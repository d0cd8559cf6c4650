#pragma once
// Fill patches as bytes (docs/exa.md, "Fill patches").

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/exa/patches/patch_disk.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Rounds the vertices of the patches to kPatchStep and puts the triangles and vertices of disks in the order of
/// walk_disk(), which is what EXA stores compactly. Twice is the same as once.
void settle_patches(std::vector<FillPatch>& patches, std::int64_t vertex_count);

/// The surface that the patches close: rims are told by its borders between partitions.
struct PatchSurroundings {
  const QuadMesh& mesh;
  std::span<const PartitionId> quad_partition;  ///< empty: all 0
};

/// One chunk. Lossless; compact for settled patches.
std::vector<std::string> encode_patches(const std::vector<FillPatch>& patches, const PatchSurroundings& around);
/// kBadData: counts beyond what the bytes can hold, ids of vertices that do not exist, positions that are not finite.
Result<std::vector<FillPatch>> decode_patches(std::span<const std::string_view> chunks,
                                              const PatchSurroundings& around);
/// The same checks on a model in memory.
Result<void> check_patches(const std::vector<FillPatch>& patches, std::int64_t vertex_count);

}  // namespace dubsar
