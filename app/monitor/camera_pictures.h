#pragma once
// A webcam from the command line: does it deliver, and its pictures as files.

#include <string>

#include "app/cli/verb.h"

namespace dubsar::app {

/// Opens the first usable camera for `seconds` and counts its pictures; with a folder, which is made, it also
/// writes them there, for --input webcam:replay=FOLDER. kUnavailable, kPermission: no camera; kCannotCreate,
/// kIo.
Result<VerbResult> watch_camera(const std::string& folder, double seconds, Progress& progress);

}  // namespace dubsar::app
