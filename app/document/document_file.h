#pragma once
// Documents as JSON files: versioned, written whole or not at all, written again by themselves while somebody works.

#include <filesystem>
#include <future>
#include <string>
#include <string_view>

#include "app/document/document.h"
#include "core/base/result.h"
#include "core/base/system/clock.h"

namespace dubsar::app {

/// Exact: format_document(parse_document(t)) is t for every text t that format_document made.
std::string format_document(const Document& document);

/// kBadData, in one sentence with what was found and expected, for text that is no document of this program, of a newer
/// version, or out of range.
Result<Document> parse_document(std::string_view text, std::string_view source);

/// Errors of write_file_atomically() and read_text_file() besides.
Result<void> save_document(const std::filesystem::path& path, const Document& document);
Result<Document> load_document(const std::filesystem::path& path);

/// Keeps a copy of the document on the disk, at most ten seconds behind. One thread.
class Autosave {
 public:
  /// Where the copies of a surface live: one file in `folder` for each path of a surface.
  static std::filesystem::path file_for(const std::filesystem::path& folder, const SourceFile& source);

  /// An empty path: nothing is kept.
  explicit Autosave(std::filesystem::path file) : file_(std::move(file)) {}
  /// What an earlier session of the same surface left behind when it was killed; or left behind in order.
  /// kBadData for a file that cannot be read or is of another surface; it is left where it is.
  Result<Document> left_behind(const SourceFile& source) const;
  bool has_left_behind() const;

  /// Writes when the document differs from what was written and five seconds have passed since then, in a thread of
  /// its own: a disk takes longer than a picture may. What went wrong is told by the next call.
  Result<void> keep(TimestampNs now, const Document& document);
  /// Waits for what is being written. Errors of save_document().
  Result<void> settle();
  /// An orderly end of a session with work in it: the next one finds it.
  Result<void> leave(const Document& document);
  /// An orderly end: nothing is left behind.
  void discard();

 private:
  std::filesystem::path file_;
  Document written_;
  TimestampNs next_ = 0;
  bool any_ = false;
  std::future<Result<void>> writing_;  ///< written_; its file is ours alone until then
};

}  // namespace dubsar::app
