#pragma once
// The files of a session as its window shows them: which are open, which can be, what the window is called.

#include <filesystem>
#include <string>
#include <vector>

#include "app/document/ui_state.h"
#include "app/panels/open_dialogue.h"
#include "app/session/file_loader.h"

namespace dubsar::app {

/// One thread: that of the session.
class FileList {
 public:
  /// `loader` outlives it; null: the session shows one surface, and no other.
  explicit FileList(FileLoader* loader) : loader_(loader) {}
  FileLoader* loader() const noexcept { return loader_; }
  bool opening() const noexcept { return loader_ != nullptr && loader_->busy(); }
  /// As Workplace says; kUsage without a loader.
  Result<void> open(const std::vector<std::filesystem::path>& files);
  Result<void> open_recent(std::size_t number);
  Result<void> step(int by);
  std::string next_file() const;
  std::string present_folder() const;
  /// What the panels show of files; folders are looked into while somebody chooses.
  FilesState state(const Choosing& choosing, bool has_surface, TimestampNs now);
  /// Of the file that is shown under the name `shown`, or of the one that is being read.
  std::string title(const std::string& shown) const;

 private:
  FileLoader* loader_;
  FolderListing listing_;
  std::vector<RecentFile> recent_;
  TimestampNs listed_ = -1;
};

}  // namespace dubsar::app
