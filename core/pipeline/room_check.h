#pragma once
// Will a run fit? Said before the scan is read.

#include "core/base/system/budget.h"
#include "core/pipeline/detail.h"
#include "core/pipeline/stage_clock.h"
#include "core/volume/formats/import.h"

namespace dubsar {

/// Looks at the size of the scan alone, and where that leaves doubts at some slices of it (forecast.h; one more stage,
/// "forecast"). kTryAgain with what is needed and what is left when it is clear that the run would not fit: it could be
/// off by a quarter. The stage that traces contact is left out: it takes what the contact is large. Errors of
/// open_volume(); kCancelled. A scan of which nothing can be foretold passes.
Result<void> check_room(const ImportOptions& scan, Detail wanted, StageRun run);

}  // namespace dubsar
