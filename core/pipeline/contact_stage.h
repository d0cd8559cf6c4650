#pragma once
// The stage that goes back to the scan where tablet and envelope touch (core/contact).

#include "core/contact/trace.h"
#include "core/filter/edge_spread.h"
#include "core/pipeline/stage_clock.h"
#include "core/volume/formats/import.h"

namespace dubsar {

struct TracedModel {
  SurfaceModel model;
  ContactReport contact;
};

/// Traces the contact of a separated model with filled holes, on the scan's grid, in the scan, which is read again: the
/// slices around the contact. `blur`: of the scan, where it is known. Errors: those of open_volume() and of its source.
Result<TracedModel> trace(SurfaceModel model, const ImportOptions& scan, const std::optional<EdgeSpread>& blur,
                          StageRun run);

}  // namespace dubsar
