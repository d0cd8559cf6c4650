#pragma once
// Finds what a scanned object stands in: foam, plastic, sand, a foot of another material than clay.

#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/filter/flat_regions.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// What becomes of a holder.
enum class HolderFate {
  kAir,          ///< it counts as air
  kTakenOff,     ///< its voxels are given the air's level
  kStays,        ///< as a part of the object: its level is not told from clay's for sure
  kStaysInside,  ///< the same, since it does not reach the border: it may be a part of the object
};

struct Holder {
  double air = 0.0, clay = 0.0, grey = 0.0;  ///< levels, grey values
  double share = 0.0;                        ///< of the scan
  int axis = 0;                              ///< along which it lies beside the object: 0 x, 1 y, 2 z
  bool at_high_end = false;                  ///< of that axis
  double reach_vox = 0.0;                    ///< how far it comes in from that end of the grid, voxels of the scan
  bool at_border = false;                    ///< it reaches the border of the grid or of the field of view
  HolderFate fate = HolderFate::kAir;

  double of_clay() const noexcept { return (grey - air) / (clay - air); }
  bool counts_as_air() const noexcept { return fate == HolderFate::kAir || fate == HolderFate::kTakenOff; }
};

struct FoundHolder {
  Holder holder;
  CellMeans grid;
  std::vector<std::uint8_t> inside;  ///< of each cell: 1 where it is the holder's, or passes its border
};

/// What the search is told of the source.
struct HolderOptions {
  double voxels_a_step = 1.0;     ///< 1: the source is the scan; 2: the scan after 2:1
  std::int64_t slices = 4;        ///< read of each layer of cells, at most
  std::optional<float> left_out;  ///< value of voxels that are no measurement
};

/// "a holder of .31 of the clay's grey at the low end of z, 13.4 mm high, 14 % of the volume: counts as air".
/// `voxel`: of the scan.
std::string describe(const Holder& holder, const VoxelSize& voxel);

/// The largest region of one level between air and clay, or above it, and all others of that level, that are seen from
/// outside, with an object of another level that is seen from outside, too, and not through it: neither is within the
/// other, as tablet and envelope of two clays are. Of two levels the lower one is the holder's, unless only the higher
/// one reaches the border. Looked for in cells of 4 voxels (larger ones in scans of more than 384), then in cells twice
/// as wide, in which there is less noise. Nothing in scans in which no region is as even as noise lets it be, or none
/// has a hundredth of the volume. Errors: those of the source, kCancelled.
Result<std::optional<FoundHolder>> find_holder(SlabSource& source, const HolderOptions& options, Progress& progress);

}  // namespace dubsar
