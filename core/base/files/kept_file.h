#pragma once
// A file that a person may have made, or another program: it is replaced or removed only while it is what we know.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

/// What became of a file that was to be replaced or removed.
enum class Kept {
  kDone,
  kStranger,  ///< something else is there than was read or written last; it was left alone
};

/// The only way to replace or remove such a file. It knows by their checksum the bytes that it read or wrote last; at
/// first it knows nothing, and takes the place of nothing. Of several processes that use it on one file one writes at a
/// time (FileLock). One thread.
class KeptFile {
 public:
  /// An empty path: there is no file, and none can be written.
  explicit KeptFile(std::filesystem::path file = {}) : file_(std::move(file)) {}
  const std::filesystem::path& path() const noexcept { return file_; }

  /// The text that is there, which is known from then on; none: nothing is there, which is known, too. kBadData: a
  /// folder or something else that is no file, or more than `max_bytes`; kPermission, kIo. After an error it knows
  /// nothing.
  Result<std::optional<std::string>> read(std::int64_t max_bytes = kLargest);

  /// Whole or not at all. Its folder must be there. Errors of FileLock::take() and AtomicFile.
  Result<Kept> write(std::string_view text);
  Result<Kept> remove();
  /// Whether what is there is what was read or written last.
  bool is_known() const;

  /// Whatever is there gets the name NAME.orphan-DATE, by the day of its last change (UTC), -2, -3 ... where that is
  /// taken; returns it. Then nothing is there, which is known. kNoInput: there is nothing; kIo, kPermission.
  Result<std::filesystem::path> set_aside();

  static constexpr std::int64_t kLargest = std::int64_t{64} << 20;  ///< that is read, in bytes

 private:
  std::filesystem::path file_;
  std::optional<std::string> known_ = std::string();  ///< checksum; "": nothing is there; none: not known
};

/// The day in a name that set_aside() gave, as 2026-11-27; empty: it is none.
std::string set_aside_day(const std::filesystem::path& file);

/// The names that set_aside() gave to files that had this one.
std::vector<std::filesystem::path> set_aside_of(const std::filesystem::path& file);

}  // namespace dubsar
