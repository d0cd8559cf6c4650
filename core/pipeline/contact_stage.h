#pragma once
// The stage that closes tablet and envelope where they touch (core/contact).

#include <optional>
#include <string>

#include "core/contact/trace.h"
#include "core/exa/offsets/settle.h"
#include "core/pipeline/volume_stages.h"

namespace dubsar {

struct ClosedModel {
  SurfaceModel model;
  ContactReport contact;
};

struct ClosingOptions {
  std::optional<std::string> smooth;  ///< why the contact is not traced in the scan
  ContactRules rules{};
  SettleOptions settle{};  ///< of what labels change
};

/// Puts one mesh of labelled points where smooth patches lie between the parts of a separated model with filled holes.
/// The contact is traced in slices of the scan, which are read again, and halved where the surface is that of the
/// halved grid; without rings and with straightened rays where `imported` has them. Else it is where the patches are.
/// Errors: those of the scan.
Result<ClosedModel> close_contact(SurfaceModel model, const ClosingOptions& options, ImportedGrid& imported,
                                  StageRun run);

}  // namespace dubsar
