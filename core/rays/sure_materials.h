#pragma once
// Voxels that are clay or air for sure: beyond a threshold by Otsu's rule, and away from everything that is not.

#include <cstdint>
#include <vector>

#include "core/rays/lane_planes.h"

namespace dubsar {

enum class Material : std::uint8_t { kUnsure, kAir, kClay };

struct SureMaterials {
  std::vector<Material> of_voxel;  ///< of each voxel of the volume
  std::int64_t air = 0, clay = 0;  ///< voxels
  GreyLevels levels;               ///< medians
};

/// All that are at least `margin` voxels (largest coordinate) away from the other side of the threshold. kBadData where
/// the volume has no two materials.
Result<SureMaterials> find_sure_materials(const Volume<float>& volume, std::int64_t margin);

}  // namespace dubsar
