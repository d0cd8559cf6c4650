#pragma once
// A sink together with the window it needs, and what is done when the driver cannot give that window.

#include <memory>
#include <string>

#include "display/render/context/context_glfw.h"
#include "display/sinks/catalog/sink_catalog.h"

namespace dubsar {

/// Destroyed from the bottom to the top: the sink's GL objects go before the window. (Assignment would go the other
/// way.)
struct SinkWindow {
  SinkWindow() = default;
  SinkWindow(SinkWindow&&) = default;
  SinkWindow& operator=(SinkWindow&&) = delete;
  std::unique_ptr<GlfwWindow> window;
  std::unique_ptr<OutputSink> sink;  ///< configured for the window's place
  SinkSpec display;                  ///< what is shown
  std::string note;                  ///< a sentence when the display is not the one asked for, or will not look right
};

/// Opens the window for `sink`, which catalog.make(display) made. Displays that need exact pixels get no borders. A
/// display that needs a stereo visual and cannot have one becomes `fallback`, and the note says so. Errors: those of
/// the window and of SinkCatalog::make.
Result<SinkWindow> open_sink_window(const SinkCatalog& catalog, const SinkSpec& display,
                                    std::unique_ptr<OutputSink> sink, WindowOptions options,
                                    const SinkSpec& fallback = {"side_by_side"});

/// The same, and makes the sink.
Result<SinkWindow> open_sink_window(const SinkCatalog& catalog, const SinkSpec& display, const WindowOptions& options,
                                    const SinkSpec& fallback = {"side_by_side"});

}  // namespace dubsar
