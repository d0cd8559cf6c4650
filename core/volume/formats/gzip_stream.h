#pragma once
// A gzip (or zlib) stream inside a file, read from front to back.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/base/files/input_file.h"

namespace dubsar {

/// One thread. gzip_stream.cpp is the only source of this room that includes zlib.h.
class GzipStream {
 public:
  GzipStream(InputFile file, std::int64_t offset);
  GzipStream(GzipStream&&) noexcept;
  GzipStream& operator=(GzipStream&&) = delete;
  ~GzipStream();

  /// Fills `out` with the next unpacked bytes. kBadData: damaged, or the stream ends before.
  Result<void> read(std::span<std::byte> out);
  Result<void> rewind();
  const InputFile& file() const noexcept { return file_; }

 private:
  struct State;
  InputFile file_;
  std::int64_t begin_ = 0, at_ = 0;
  std::unique_ptr<State> state_;
};

}  // namespace dubsar
