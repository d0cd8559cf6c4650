#pragma once
// The stage that looks for what the scanner took from rays, and gives it back (core/rays).

#include <optional>
#include <string>

#include "core/base/text/enum_names.h"
#include "core/pipeline/volume_stages.h"
#include "core/rays/bent_rays.h"

namespace dubsar {

enum class Artefacts {
  kAuto,  ///< given back where it is significant
  kOff,   ///< the scan as it is
};
inline constexpr EnumName<Artefacts> kArtefacts[] = {{Artefacts::kAuto, "auto"}, {Artefacts::kOff, "off"}};
static_assert(names_all(kArtefacts, static_cast<std::size_t>(Artefacts::kOff) + 1));

/// A scan as a whole, where bent rays are looked for first: itself (`voxels_a_step` 1) or its halved grid (2).
struct Overview {
  SlabSource& grid;
  double voxels_a_step = 1.0;
};

struct RaysLook {
  std::optional<BentRays> bent;
  GreyLevels levels;
  SeenBend seen;  ///< of all axes
};

/// Looks for bent rays about each axis at some 100 cells a side, and where there are any, measures them at some 300. Of
/// every cell of voxels some are read. One record, "rays". Errors: those of the sources, kCancelled.
Result<RaysLook> look_for_bent_rays(Overview overview, SlabSource& scan, StageRun run);

/// The run straightens rays: time, and where the straightened grid lies, in memory if all of the run still fits `room`.
void plan_straightening(RunShape& run, const BentRays& bent, std::uint64_t room);

/// Looks in the halved grid, there for an axis that was off, too, where no ray is bent, and straightens what the
/// surface is found in: that grid, or the scan, which is read once more for it; `imported.straightened` is there then,
/// and grid and blur are those of what was straightened. Nothing changes where no ray is bent. Records "rays",
/// "straighten". A scan for which there is no room stays as it is, and the report says why; `shape` says so afterwards.
/// Errors: those of the scan, kCancelled.
Result<RaysReport> straighten_rays(ImportedGrid& imported, RunShape& shape, std::uint64_t room, const Budget& budget,
                                   StageRun run);

}  // namespace dubsar
