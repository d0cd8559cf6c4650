#pragma once
// What a folder holds that can be opened, for the open dialogue.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dubsar::app {

/// Suffixes of surfaces that can be read, in lower case.
std::span<const std::string_view> surface_suffixes();
/// Whether a name ends in one of them, in capitals or not.
bool names_a_surface(const std::filesystem::path& path);

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
