#pragma once
// The stage that goes back to the scan where tablet and envelope touch (core/contact).

#include "core/contact/trace.h"
#include "core/pipeline/volume_stages.h"

namespace dubsar {

struct TracedModel {
  SurfaceModel model;
  ContactReport contact;
};

/// Traces the contact of a separated model with filled holes, on its grid. The scan is read again, the slices around
/// the contact, and halved where the surface is that of the halved grid; with straightened rays where `imported` has
/// them. Of `imported` only those, the detail that was taken and the blur of its grid are looked at. Errors: those of
/// open_volume() and of its source.
Result<TracedModel> trace(SurfaceModel model, const ImportOptions& scan, const ImportedGrid& imported, StageRun run);

}  // namespace dubsar
