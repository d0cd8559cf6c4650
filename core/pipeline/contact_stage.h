#pragma once
// The stage that goes back to the scan where tablet and envelope touch (core/contact).

#include "core/contact/trace.h"
#include "core/pipeline/stage_clock.h"
#include "core/volume/import.h"

namespace dubsar {

struct TracedModel {
  SurfaceModel model;
  ContactReport contact;
};

/// Traces the contact of a separated model with filled holes in the scan, which is read again: the slices around the
/// contact. `resampled`: the model's grid is the scan's halved. Errors: those of open_volume() and of its source.
Result<TracedModel> trace(SurfaceModel model, const ImportOptions& scan, bool resampled, StageRun run);

}  // namespace dubsar
