#pragma once
// What the end of a file's name says it is.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace dubsar {

/// ".exa" of "Tablet.EXA"; empty where there is none.
inline std::string lower_suffix(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return std::tolower(c); });
  return suffix;
}

}  // namespace dubsar
