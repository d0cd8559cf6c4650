#pragma once
// A regular file opened for reading at offsets. Every importer starts here, so that a missing file, a folder, a pipe or
// a file without read permission gets the same sentence and exit code everywhere.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/base/result.h"

namespace dubsar {

class InputFile {
 public:
  /// Never blocks. kNoInput: missing; kPermission; kBadData: a folder, pipe, socket or device.
  static Result<InputFile> open(const std::filesystem::path& path);

  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  /// Size when the file was opened.
  std::int64_t size() const noexcept { return size_; }
  const std::filesystem::path& path() const noexcept { return path_; }

  /// Fills `out` from `offset` by pread. kBadData when the file ends before (it was cut, or shrank since). Any thread.
  Result<void> read_at(std::int64_t offset, std::span<std::byte> out) const;

  /// The system may fetch these bytes from the disk while the program does something else. Any thread; never fails.
  void will_read(std::int64_t offset, std::int64_t bytes) const noexcept;

 private:
  InputFile() = default;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
  std::filesystem::path path_;
};

/// `count` bytes from `offset`, for parsers that want a piece in memory. kBadData when the file is shorter, kTryAgain
/// when memory is short.
Result<std::string> read_bytes(const InputFile& file, std::int64_t offset, std::int64_t count);

/// All bytes of a file of any size that fits in memory.
Result<std::string> read_file_bytes(const std::filesystem::path& path);

}  // namespace dubsar
