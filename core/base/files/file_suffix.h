#pragma once
// What the end of a file's name says it is.

#include <filesystem>
#include <string>

#include "core/base/text/lower_text.h"

namespace dubsar {

/// ".exa" of "Tablet.EXA"; empty where there is none.
inline std::string lower_suffix(const std::filesystem::path& path) { return lower_text(path.extension().string()); }

}  // namespace dubsar
