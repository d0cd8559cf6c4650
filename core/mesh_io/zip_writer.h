#pragma once
// A ZIP archive written as it grows: deflated entries, no dates, so that the same content gives the same bytes.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/files/atomic_file.h"
#include "core/base/result.h"

namespace dubsar {

/// Writes to a file that outlives it; the caller commits. One thread. Errors: kUsage beyond 4 GiB (no ZIP64),
/// kTryAgain (memory), those of AtomicFile::write().
class ZipWriter {
 public:
  explicit ZipWriter(AtomicFile& file);
  ~ZipWriter();
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  Result<void> begin(std::string_view name);
  Result<void> write(std::string_view bytes);  ///< of the entry that was begun last
  Result<void> end();
  Result<void> finish();  ///< the directory

 private:
  struct Entry {
    std::string name;
    std::uint32_t crc = 0;
    std::uint64_t packed = 0, bytes = 0, offset = 0;
  };
  struct Deflater;
  std::string local_header(const Entry& entry) const;
  Result<void> deflate(std::string_view bytes, bool last);

  AtomicFile& file_;
  std::vector<Entry> entries_;
  std::unique_ptr<Deflater> deflater_;
  std::uint64_t written_ = 0;
};

}  // namespace dubsar
