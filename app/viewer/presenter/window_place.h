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

/// A window as far as displays differ in it.
struct WindowKind {
  Screen screen{};          ///< of its monitor
  double refresh_hz = 0.0;  ///< 0: the monitor does not say
  bool stereo = false;      ///< it has a buffer for each eye
};

/// Displays that such a window can show: `first`, then of all that the catalog offers, plug-ins too, those whose traits
/// say so: any pixels or just the screen's, no headset, a stereo window where they need one, 100 Hz where eyes take
/// turns.
std::vector<SinkSpec> displays_for_window(const SinkSpec& first, const SinkCatalog& catalog, const WindowKind& window);

}  // namespace dubsar::app
