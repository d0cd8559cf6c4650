#pragma once
// Memory's overflow: a file without a name, gone when it is closed or the program ends.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "core/base/result.h"

namespace dubsar {

class ScratchFile {
 public:
  /// In `folder`, which must be on a disk with room for what will be written. kCannotCreate, kPermission, kIo.
  static Result<ScratchFile> create(const std::filesystem::path& folder);

  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&& other) noexcept;
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();

  /// Any thread, as long as ranges do not overlap. kIo: the disk is full.
  Result<void> write_at(std::int64_t offset, std::span<const std::byte> bytes);
  /// Fills `out` with bytes written before. kIo.
  Result<void> read_at(std::int64_t offset, std::span<std::byte> out) const;

 private:
  explicit ScratchFile(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace dubsar
