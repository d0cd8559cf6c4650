#pragma once
// Numbers of a few bits, packed without gaps, lowest bit first.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace dubsar {

class BitWriter {
 public:
  /// The lowest `bits` (1..32) bits of `value`.
  void put(std::uint32_t value, int bits) {
    pending_ |= std::uint64_t{value & static_cast<std::uint32_t>((std::uint64_t{1} << bits) - 1)} << filled_;
    for (filled_ += bits; filled_ >= 8; filled_ -= 8, pending_ >>= 8)
      bytes_.push_back(static_cast<char>(pending_ & 255));
  }
  /// The bytes so far; the last is filled up with 0 bits.
  std::string take() {
    if (filled_ > 0) bytes_.push_back(static_cast<char>(pending_ & 255));
    pending_ = 0;
    filled_ = 0;
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
  std::uint64_t pending_ = 0;
  int filled_ = 0;
};

/// Reads what BitWriter wrote. The caller checks packed_bytes() first; past the end come zeros.
class BitReader {
 public:
  explicit BitReader(std::string_view bytes) noexcept : bytes_(bytes) {}
  std::uint32_t get(int bits) noexcept {
    for (; filled_ < bits; filled_ += 8)
      if (next_ < bytes_.size()) pending_ |= std::uint64_t{static_cast<unsigned char>(bytes_[next_++])} << filled_;
    const auto value = static_cast<std::uint32_t>(pending_ & ((std::uint64_t{1} << bits) - 1));
    pending_ >>= bits;
    filled_ -= bits;
    return value;
  }
  /// Bits that fill up the last byte; 0 in a file that we wrote.
  std::uint64_t padding() const noexcept { return pending_; }

 private:
  std::string_view bytes_;
  std::size_t next_ = 0;
  std::uint64_t pending_ = 0;
  int filled_ = 0;
};

constexpr std::uint64_t packed_bytes(std::uint64_t count, int bits) noexcept {
  return (count * static_cast<std::uint64_t>(bits) + 7) / 8;
}

}  // namespace dubsar
