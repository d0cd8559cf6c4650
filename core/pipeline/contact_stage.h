#pragma once
// The stage that goes back to the scan where tablet and envelope touch (core/contact).

#include "core/contact/trace.h"
#include "core/exa/offsets/settle.h"
#include "core/pipeline/volume_stages.h"

namespace dubsar {

struct TracedModel {
  SurfaceModel model;
  ContactReport contact;
};

/// Traces the contact of a separated model with filled holes, on its grid. Slices of the scan around the contact are
/// read again, and halved where the surface is that of the halved grid; without rings and with straightened rays where
/// `imported` has them. What labels change is settled as `settling` says. Errors: those of the scan.
Result<TracedModel> trace(SurfaceModel model, ContactMesh mesh, const SettleOptions& settling, ImportedGrid& imported,
                          StageRun run);

}  // namespace dubsar
