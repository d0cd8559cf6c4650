#pragma once
// Which monitor a display's window belongs on, and which displays a window can show.

#include <optional>
#include <vector>

#include "display/render/context/context_glfw.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "display/sinks/output_sink.h"

namespace dubsar::app {

/// Sets `fullscreen` and `monitor` of `window`: as told, else displays that need exact pixels cover a monitor, that of
/// `window.monitor` or the one that has the panel's pixels. `display` has not seen a window yet. Errors: those of
/// list_monitors().
Result<void> choose_place(const SinkTraits& display, std::optional<bool> fullscreen, WindowOptions& window);

/// Displays that a window on this screen can show: `first`, those for any monitor, panels of exactly this size, and
/// quad_buffer in a stereo window.
std::vector<SinkSpec> displays_for_window(const SinkSpec& first, const Screen& screen, bool stereo,
                                          const PanelSet& panels);

}  // namespace dubsar::app
