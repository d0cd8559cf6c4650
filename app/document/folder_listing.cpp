#include "app/document/folder_listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "app/document/file_kinds.h"
#include "app/words/text.h"
#include "core/base/text/lower_text.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kMostEntries = 2000;

}  // namespace

FolderListing list_folder(const fs::path& folder) {
  FolderListing out;
  std::error_code error;
  out.folder = fs::absolute(folder, error).lexically_normal().string();
  fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  if (error) {
    out.problem = tr("files.cannot_look", out.folder, error.message());
    return out;
  }
  for (const fs::directory_iterator end; at != end && out.entries.size() < kMostEntries; at.increment(error)) {
    if (error) break;
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    const bool is_folder = at->is_directory(ignored);
    if (name.starts_with(".") || (!is_folder && !names_a_surface(at->path()))) continue;
    const auto bytes = is_folder ? 0 : at->file_size(ignored);
    out.entries.push_back({name, is_folder, ignored ? 0 : static_cast<std::int64_t>(bytes)});
  }
  std::sort(out.entries.begin(), out.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    if (a.folder != b.folder) return a.folder;
    const std::string first = lower_text(a.name), second = lower_text(b.name);
    return first != second ? first < second : a.name < b.name;
  });
  return out;
}

std::string size_words(std::int64_t bytes) {
  const auto size = static_cast<double>(bytes);
  if (bytes < 1000) return fmt::format("{} B", bytes);
  if (size < 1e6) return fmt::format("{:.0f} kB", size / 1e3);
  return local_figures(size < 1e9 ? fmt::format("{:.1f} MB", size / 1e6) : fmt::format("{:.1f} GB", size / 1e9));
}

}  // namespace dubsar::app
