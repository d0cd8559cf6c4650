#pragma once
// The files that were opened last, in the user's state folder.

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dubsar::app {

inline constexpr std::size_t kMostRecent = 10;

/// Absolute paths, newest first, each once; whether they are still there is not asked. A list that is missing, damaged
/// or of another program is empty.
std::vector<std::string> read_recent(const std::filesystem::path& list);

/// Puts a file first; the list is written whole or not at all, its folder is made; a list that cannot be read is set
/// aside. Without a name of the list nothing happens. Errors of KeptFile.
Result<void> remember_recent(const std::filesystem::path& list, const std::filesystem::path& file);

}  // namespace dubsar::app
