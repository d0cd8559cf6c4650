#pragma once
// Where the user's own files of the program are.

#include <filesystem>
#include <vector>

namespace dubsar::app {

/// $XDG_CONFIG_HOME/dubsar, else $HOME/.config/dubsar; empty when neither variable is set.
std::filesystem::path config_folder();

/// Panel profiles and adjustments: config_folder() / "panels".
std::filesystem::path panel_folder();

/// The networks that `./do models` fetched: $XDG_DATA_HOME/dubsar/models, else $HOME/.local/share/dubsar/models; empty
/// when neither variable is set.
std::filesystem::path model_folder();

/// Work on surfaces, by their content: $XDG_STATE_HOME/dubsar/sessions, else
/// $HOME/.local/state/dubsar/sessions; empty when neither variable is set.
std::filesystem::path session_folder();

/// The list of the files that were opened last, beside session_folder().
std::filesystem::path recent_list();

/// Where desktops mount USB storage of the user: /media/$USER and /run/media/$USER.
std::vector<std::filesystem::path> mount_folders();

}  // namespace dubsar::app
