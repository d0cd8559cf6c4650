#pragma once
// Which monitor a display's window belongs on, and which displays a window can show.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/viewer/session.h"
#include "display/render/context_glfw.h"

namespace dubsar::app {

/// Sets `fullscreen` and `monitor` of `window`: as told, else displays that need exact pixels cover a monitor, that of
/// `window.monitor` or the one that has the panel's pixels. Errors: those of make_sink() and list_monitors().
Result<void> choose_place(const SessionOptions& session, std::optional<bool> fullscreen, WindowOptions& window);

/// Displays that a window on this screen can show, as make_sink() reads them: `first`, those for any monitor,
/// panels of exactly this size, and quad_buffer in a stereo window.
std::vector<std::string> displays_for_window(const std::string& first, const Screen& screen, bool stereo,
                                             const std::filesystem::path& profile_folder);

}  // namespace dubsar::app
