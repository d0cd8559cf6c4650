#pragma once
// Collects small writes to an AtomicFile into large ones. The first error is kept and ends all further writing.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/files/atomic_file.h"
#include "core/base/numbers/bytes.h"
#include "core/base/result.h"

namespace dubsar {

class BufferedWriter {
 public:
  explicit BufferedWriter(AtomicFile& file) : file_(&file) { buffer_.reserve(kCapacity + 4096); }

  void text(std::string_view bytes) {
    buffer_.append(bytes);
    if (buffer_.size() >= kCapacity) spill();
  }
  template <class T>
  void little(T value) {
    append_little(buffer_, value);
    if (buffer_.size() >= kCapacity) spill();
  }
  bool ok() const noexcept { return status_.has_value(); }
  /// Call once at the end, before AtomicFile::commit().
  Result<void> flush() {
    spill();
    return std::move(status_);
  }

 private:
  static constexpr std::size_t kCapacity = std::size_t{1} << 20;
  void spill() {
    if (status_ && !buffer_.empty()) status_ = file_->write(buffer_);
    buffer_.clear();
  }
  AtomicFile* file_;
  std::string buffer_;
  Result<void> status_;
};

}  // namespace dubsar
