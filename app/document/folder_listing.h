#pragma once
// What a folder holds that can be opened, for the open dialogue.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace dubsar::app {

struct FolderEntry {
  std::string name;
  bool folder = false;
  std::int64_t bytes = 0;
  friend bool operator==(const FolderEntry&, const FolderEntry&) = default;
};

struct FolderListing {
  std::string folder;                ///< absolute
  std::vector<FolderEntry> entries;  ///< folders first, then surfaces, each by name; hidden ones are left out
  std::string problem;               ///< why it cannot be looked into; empty: it can
  friend bool operator==(const FolderListing&, const FolderListing&) = default;
};

/// At most 2000 entries.
FolderListing list_folder(const std::filesystem::path& folder);

/// "2.9 MB", "730 kB".
std::string size_words(std::int64_t bytes);

}  // namespace dubsar::app
