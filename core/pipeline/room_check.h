#pragma once
// Will a run fit? Decided, with the grid on which it runs, before the scan is read.

#include "core/pipeline/detail.h"
#include "core/pipeline/stage_clock.h"
#include "core/volume/formats/import.h"

namespace dubsar {

struct FittingRun {
  DetailChoice detail;
  RunShape run;
  std::uint64_t room = 0;  ///< bytes that it may take beside the program as it is now
};

/// `wanted`: what the run is to do; scan, grid, vertices and places are filled in. The size of the scan decides, and
/// where that leaves doubts some slices of it (forecast.h; one more record, "forecast"). kTryAgain with what is needed
/// and what is left: where a limit is set (set_memory_limit) by the plan, else only where it is clear, as the plan errs
/// on the side of too much. kCancelled. Errors of the scan.
Result<FittingRun> fit_run(ImportedVolume& scan, const RunShape& wanted, Detail detail, const Budget& budget,
                           StageRun run);

}  // namespace dubsar
