#include "app/cli/config_folder.h"

#include <cstdlib>

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {
fs::path from_environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? fs::path(value) : fs::path();
}
}  // namespace

fs::path config_folder() {
  if (const fs::path xdg = from_environment("XDG_CONFIG_HOME"); xdg.is_absolute()) return xdg / "dubsar";
  const fs::path home = from_environment("HOME");
  return home.empty() ? fs::path() : home / ".config" / "dubsar";
}

fs::path panel_folder() {
  const fs::path config = config_folder();
  return config.empty() ? config : config / "panels";
}

fs::path model_folder() {
  if (const fs::path xdg = from_environment("XDG_DATA_HOME"); xdg.is_absolute()) return xdg / "dubsar" / "models";
  const fs::path home = from_environment("HOME");
  return home.empty() ? fs::path() : home / ".local" / "share" / "dubsar" / "models";
}

fs::path session_folder() {
  if (const fs::path xdg = from_environment("XDG_STATE_HOME"); xdg.is_absolute()) return xdg / "dubsar" / "sessions";
  const fs::path home = from_environment("HOME");
  return home.empty() ? fs::path() : home / ".local" / "state" / "dubsar" / "sessions";
}

fs::path recent_list() {
  const fs::path sessions = session_folder();
  return sessions.empty() ? sessions : sessions.parent_path() / "recent.json";
}

std::vector<fs::path> mount_folders() {
  fs::path user = from_environment("USER");
  if (user.empty()) user = from_environment("LOGNAME");
  if (user.empty()) return {};
  return {"/media" / user, "/run/media" / user};
}

}  // namespace dubsar::app
