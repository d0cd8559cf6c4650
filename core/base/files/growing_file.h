#pragma once
// A file that is of use while it grows: whatever ends the program, what was appended stays readable, and no older file
// is lost for it.

#include <filesystem>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// Where no file of that name is, it grows there; an older one stays as it is until finish(), and this one grows beside
/// it as NAME.partial (.partial2 ... where earlier ones were left). Symbolic links are followed; FIFOs and devices are
/// written to as they are. Uses write(2) without a buffer of its own, so that what append() has taken survives the end
/// of the process. One thread.
class GrowingFile {
 public:
  /// kCannotCreate: no such folder, a folder of that name, a link to nothing. kPermission, kIo.
  static Result<GrowingFile> create(const std::filesystem::path& target);

  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&&) = delete;
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  ~GrowingFile();  ///< leaves it where it is

  Result<void> append(std::string_view text);
  /// Syncs it and gives it its name; nothing is appended afterwards.
  Result<void> finish();
  /// Takes it away again; an older file stays.
  void discard() noexcept;

  /// Where the bytes are now.
  const std::filesystem::path& path() const noexcept { return path_; }
  /// False while it grows beside an older file.
  bool has_its_name() const noexcept { return path_ == target_; }

 private:
  GrowingFile() = default;
  int descriptor_ = -1;
  bool regular_ = true;
  std::filesystem::path target_, path_;
};

}  // namespace dubsar
