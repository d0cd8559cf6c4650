#pragma once
// A sink together with the window it needs, and what is done when the driver cannot give that window.

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "display/render/context_glfw.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// Destroyed from the bottom to the top: the sink's GL objects go before the window. (Assignment would go the other
/// way.)
struct SinkWindow {
  SinkWindow() = default;
  SinkWindow(SinkWindow&&) = default;
  SinkWindow& operator=(SinkWindow&&) = delete;
  std::unique_ptr<GlfwWindow> window;
  std::unique_ptr<OutputSink> sink;  ///< configured for the window's place
  std::string note;                  ///< a sentence when the display is not the one asked for, or will not look right
};

/// Opens the window for `display` (as make_sink() reads it). Displays that need exact pixels get no borders. A display
/// that needs a stereo visual and cannot have one becomes `fallback`, and the note says so. Errors: those of the window
/// and of make_sink().
Result<SinkWindow> open_sink_window(std::string_view display, WindowOptions options,
                                    const std::filesystem::path& profile_folder = {},
                                    std::string_view fallback = "side_by_side",
                                    std::span<const std::shared_ptr<SinkPlugin>> plugins = {});

}  // namespace dubsar
