#pragma once
// What a scanned object stands in is looked for, and taken off where it can be told from clay (core/filter).

#include "core/pipeline/volume_stages.h"

namespace dubsar {

/// Looks for a holder in the halved grid. Where there is one that counts as air, `imported.holderless` is there then,
/// and grid, blur and the estimates of the raw scan are those of what it gives; without one no bit changes. Sets
/// `imported.facts.holder`. Records "holder", and those of reading. Errors: those of the sources, kCancelled.
Result<void> take_holder_off(ImportedGrid& imported, const Budget& budget, StageRun run);

}  // namespace dubsar
