#pragma once
// Simulated people as an input source. Named or never taken.

#include <functional>

#include "input/input_source.h"
#include "input/simulated/script.h"

namespace dubsar {

/// Plays a script from its first poll on: samples at the script's rate, seen `latency_s` later. A visitor of the script
/// looks at `seen_view` (kUsage without one).
Result<std::unique_ptr<InputSource>> play_script(Script script, std::function<ViewState()> seen_view);

/// Options: path=FILE.json, or the file as a bare word.
Result<std::unique_ptr<InputSource>> make_scripted_source(const InputConfig& config);

}  // namespace dubsar
