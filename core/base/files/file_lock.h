#pragma once
// Who may write a file now, among programs that ask: a small file beside it that names its owner.

#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace dubsar {

/// ".NAME.lock" beside the file, made by whoever comes first, with the process and the host it runs on. For moments: a
/// lock is broken when its process is no longer there, or, where that cannot be known (another host), after a minute.
class FileLock {
 public:
  /// Waits up to two seconds. kTryAgain: another process has it, which is named; kCannotCreate, kPermission, kIo: no
  /// lock can be made there.
  static Result<FileLock> take(const std::filesystem::path& file);

  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

 private:
  FileLock() = default;
  std::filesystem::path lock_;
};

}  // namespace dubsar
