#pragma once
// A picture of each screen of a kiosk: a short visit that nobody makes, led through its guide.

#include <string>
#include <vector>

#include "app/kiosk/kiosk_controller.h"
#include "app/viewer/view_options.h"
#include "core/base/progress.h"
#include "core/image_io/image.h"

namespace dubsar::app {

struct KioskScreen {
  std::string name;
  Image picture;
};

/// "attract", "teaching", "object", "text" (a tour's first step), "peel" (the envelope goes) and "operator", in this
/// order; those that the object has not, such as an envelope, are missing. `view` says display, pixels and style, as
/// for a session without a window; its inputs, its time and its guide are not looked at, nor the journal, the hours,
/// the file of the operator's key in `parts`. Makes a GL context for the time of the call; main thread. Errors of
/// run_view(). Without `words`: the same pictures without words, tutorials and buttons.
Result<std::vector<KioskScreen>> kiosk_screens(const TriMesh& mesh, ViewOptions view, KioskParts parts,
                                               Progress& progress, bool words = true);

}  // namespace dubsar::app
