#pragma once
// SpaceMouse pucks, by HID or through spacenavd.

#include "input/input_source.h"

namespace dubsar {

/// Options: replay=FILE, speed=FACTOR, simulate=SCRIPT, seed=N. Buttons are keys "puck1", "puck2", ...
Result<std::unique_ptr<InputSource>> make_spacemouse_source(const InputConfig& config);
/// The same, and socket=PATH.
Result<std::unique_ptr<InputSource>> make_spacenav_source(const InputConfig& config);

}  // namespace dubsar
