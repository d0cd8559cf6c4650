#pragma once
// The files of a session as its window shows them: which are open, which can be, what the window is called.

#include <filesystem>
#include <string>
#include <vector>

#include "app/document/ui_state.h"
#include "app/panels/open_dialogue.h"
#include "app/session/shelf.h"

namespace dubsar::app {

/// One thread: that of the session.
class FileList {
 public:
  /// `shelf` outlives it; null: the session shows one surface, and no other.
  explicit FileList(Shelf* shelf) : shelf_(shelf) {}
  Shelf* shelf() const noexcept { return shelf_; }
  bool opening() const noexcept { return shelf_ != nullptr && shelf_->busy(); }
  /// As Workplace says; kUsage without a shelf.
  Result<void> open(const std::vector<std::filesystem::path>& files);
  Result<void> open_recent(std::size_t number);
  Result<void> step(int by);
  std::string present_folder() const;
  /// What the panels show of files; folders are looked into while somebody chooses.
  FilesState state(const Choosing& choosing, bool has_surface, TimestampNs now);
  /// Of the file that is shown under the name `shown`, or of the one that is being read.
  std::string title(const std::string& shown) const;

 private:
  Shelf* shelf_;
  FolderListing listing_;
  std::vector<RecentFile> recent_;
  TimestampNs listed_ = -1;
};

}  // namespace dubsar::app
