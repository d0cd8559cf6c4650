#pragma once
// Whether a file stands still while it is read: size, time of change, place on the disk, and a look at its bytes.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

struct FileIdentity {
  std::filesystem::path path;
  std::uint64_t device = 0, inode = 0;
  std::int64_t size = 0, changed_ns = 0;  ///< bytes; of its contents, since 1970
  std::string fingerprint;                ///< file_fingerprint.h; empty: not asked for
};

/// What a file is now. Up to 256 KiB are read for its fingerprint. kNoInput, kPermission, kBadData (no file), kIo.
Result<FileIdentity> identify_file(const std::filesystem::path& path, bool with_fingerprint = true);

/// Of several files; beyond 16 of them without their fingerprints.
Result<std::vector<FileIdentity>> identify_files(std::span<const std::filesystem::path> paths);

/// kTryAgain, with a sentence that names the file, when one is not what it was: another size, time, place, or bytes.
Result<void> check_unchanged(std::span<const FileIdentity> before);

/// The result of `work`, which reads a file, or kTryAgain when the file changed meanwhile.
template <class Work>
auto while_unchanged(const std::filesystem::path& path, const Work& work) -> decltype(work()) {
  const auto before = identify_file(path);
  auto result = work();
  if (before)  // else the work says what is wrong with it
    DUBSAR_TRY(check_unchanged(std::span(&*before, 1)));
  return result;
}

}  // namespace dubsar
