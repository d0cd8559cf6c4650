#include "app/viewer/file_list.h"

#include <system_error>

#include "app/document/recent_files.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
constexpr TimestampNs kListEveryNs = 2'000'000'000;  // files that come and go while the dialogue is open

Error one_surface() { return {ErrorKind::kUsage, "this session shows one surface, and no other"}; }

}  // namespace

Result<void> FileList::open(const std::vector<fs::path>& files) {
  return loader_ != nullptr ? loader_->open(files) : tl::unexpected<Error>(one_surface());
}

Result<void> FileList::open_recent(std::size_t number) {
  if (loader_ == nullptr) return tl::unexpected<Error>(one_surface());
  const std::vector<std::string> recent = read_recent(loader_->recent_list());
  if (number < 1 || number > recent.size())
    return fail(ErrorKind::kUsage, "open_recent: {} found, expected 1 to {}", number, recent.size());
  return open({fs::path(recent[number - 1])});
}

Result<void> FileList::step(int by) {
  return loader_ != nullptr ? loader_->step(by) : tl::unexpected<Error>(one_surface());
}

std::string FileList::next_file() const {
  if (loader_ == nullptr || loader_->files().size() < 2) return {};
  return loader_->files()[(loader_->shown().value_or(0) + 1) % loader_->files().size()].string();
}

std::string FileList::present_folder() const {
  std::error_code error;
  if (loader_ != nullptr && loader_->shown()) return loader_->files()[*loader_->shown()].parent_path().string();
  if (loader_ != nullptr)
    for (const std::string& recent : read_recent(loader_->recent_list()))
      if (const fs::path folder = fs::path(recent).parent_path(); fs::is_directory(folder, error))
        return folder.string();
  return fs::current_path(error).string();
}

std::string FileList::title(const std::string& shown) const {
  return title_words(shown, loader_ != nullptr ? loader_->opening() : std::nullopt);
}

FilesState FileList::state(const Choosing& choosing, bool has_surface, TimestampNs now) {
  FilesState out;
  out.has_surface = has_surface;
  out.beside = choosing.beside;
  if (loader_ == nullptr) return out;
  for (const fs::path& file : loader_->files()) out.names.push_back(file.filename().string());
  out.shown = loader_->shown().value_or(0);
  out.opening = loader_->opening();
  if (!choosing.open) {
    listed_ = -1;
    return out;
  }
  const std::string folder = choosing.folder.empty() ? present_folder() : choosing.folder;
  if (listed_ < 0 || now - listed_ >= kListEveryNs || listing_.folder != folder) {
    listing_ = list_folder(folder);
    recent_.clear();
    for (std::string& path : read_recent(loader_->recent_list())) {
      std::error_code error;
      const bool there = fs::exists(path, error);
      recent_.push_back({std::move(path), there});
    }
    listed_ = now;
  }
  out.recent = recent_;
  out.listing = listing_;
  return out;
}

}  // namespace dubsar::app
