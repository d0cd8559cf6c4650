#pragma once
// A file that appears whole or not at all: the old one stays until the new one is complete and on the disk.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// kCannotCreate when `target` is something that a file must not take the place of: a folder, a named pipe, a socket or
/// a device, or a link that leads back to itself, or when its name is too long for the temporary file beside it (more
/// than 233 bytes on most disks). Links are followed. A file, or nothing, is fine.
Result<void> check_output_kind(const std::filesystem::path& target);

/// Writes go to a temporary file beside the target (O_EXCL; beside what a link points to, so that the link stays), with
/// the access rights of the file that it replaces; commit() syncs and renames it. Without commit() the
/// destructor removes it. Uses write(2), never stdio, so that every failure is seen. One thread.
class AtomicFile {
 public:
  /// Errors: kCannotCreate (no such folder, target is no file), kPermission, kIo (disk full: when expected_bytes is
  /// given, space is reserved first).
  static Result<AtomicFile> create(const std::filesystem::path& target, std::int64_t expected_bytes = 0);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  Result<void> write(std::span<const std::byte> bytes);
  Result<void> write(std::string_view text) { return write(std::as_bytes(std::span(text.data(), text.size()))); }
  std::int64_t size() const noexcept { return size_; }

  /// For third-party writers that need a path: they may write to temporary_path() themselves; then commit().
  const std::filesystem::path& temporary_path() const noexcept { return temporary_; }

  Result<void> commit();

 private:
  AtomicFile() = default;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
  bool owns_size_ = false;  ///< commit() cuts the file to size_ (space was reserved and we wrote all of it)
  std::filesystem::path target_, temporary_;
};

/// Whole small file in one call.
Result<void> write_file_atomically(const std::filesystem::path& target, std::span<const std::byte> bytes);
Result<void> write_file_atomically(const std::filesystem::path& target, std::string_view text);

/// Reads a whole file of at most `max_bytes`. kNoInput, kPermission, kBadData (a folder, too big), kIo.
Result<std::string> read_text_file(const std::filesystem::path& path, std::int64_t max_bytes = 8 << 20);

}  // namespace dubsar
