#pragma once
// Fill patches, which close the parts in files of versions 3 to 6 (docs/exa.md, "Fill patches"): nobody writes them any
// more; files that are made of such files carry their bytes.

#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/exa/patches/patch_disk.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// The surface that the patches close: rims are told by its borders between partitions.
struct PatchSurroundings {
  const QuadMesh& mesh;
  std::span<const PartitionId> quad_partition;  ///< empty: all 0
};

/// kBadData: not one chunk, counts beyond what the bytes can hold, ids of vertices that do not exist, positions that
/// are not finite.
Result<std::vector<FillPatch>> decode_patches(std::span<const std::string_view> chunks,
                                              const PatchSurroundings& around);

/// Fills the evidence of patches that are there already. kBadData: not one chunk.
Result<void> decode_patch_evidence(std::span<const std::string_view> chunks, std::vector<FillPatch>& patches);

}  // namespace dubsar
