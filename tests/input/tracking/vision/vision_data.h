#pragma once
// Where tests find the networks and photographs that ./do models fetched.

#include <cstdlib>
#include <filesystem>

namespace dubsar {

inline constexpr const char* kNoModels = "the networks are not here; ./do models fetches them";
inline constexpr const char* kNoPhotographs =
    "the test photographs are not here; ./do models --photographs fetches them";

inline std::filesystem::path data_folder() {
  if (const char* const data = std::getenv("XDG_DATA_HOME"); data != nullptr && *data == '/')
    return std::filesystem::path(data) / "dubsar";
  const char* const home = std::getenv("HOME");
  return home != nullptr ? std::filesystem::path(home) / ".local/share/dubsar" : std::filesystem::path("/nonexistent");
}
inline std::filesystem::path model_folder() { return data_folder() / "models"; }
inline std::filesystem::path photograph_folder() { return data_folder() / "photographs"; }

}  // namespace dubsar
