#pragma once
// A shared library that is a plug-in: found, loaded, its entry and its table checked. Loading one runs its code with
// the user's rights.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// Unloaded with its owner.
class PluginLibrary {
 public:
  /// kNoInput: no such file; kUnavailable: it cannot be loaded; kBadData: it has no function `entry`.
  static Result<PluginLibrary> load(const std::filesystem::path& file, const char* entry);
  PluginLibrary(PluginLibrary&& other) noexcept;
  PluginLibrary& operator=(PluginLibrary&&) = delete;
  PluginLibrary(const PluginLibrary&) = delete;
  PluginLibrary& operator=(const PluginLibrary&) = delete;
  ~PluginLibrary();

  template <class Entry>
  Entry entry() const noexcept {
    return reinterpret_cast<Entry>(entry_);
  }
  const std::string& path() const noexcept { return path_; }

 private:
  PluginLibrary(void* library, void* entry, std::string path)
      : library_(library), entry_(entry), path_(std::move(path)) {}
  void* library_;
  void* entry_;
  std::string path_;
};

/// What tables of plug-ins begin with.
struct PluginVersion {
  std::uint32_t abi = 0, size = 0;
};
/// kBadData: another ABI version or a table that is too short; `header` is what to build it again with.
Result<void> check_plugin_version(const std::string& file, PluginVersion found, PluginVersion expected,
                                  std::string_view header);
/// kBadData: not 1 to 32 of a-z, 0-9 and _.
Result<void> check_plugin_name(const std::string& file, std::string_view name);

}  // namespace dubsar
