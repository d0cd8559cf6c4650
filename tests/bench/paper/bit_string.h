#pragma once
// Numbers of any width one after the other, lowest bit first, as the paper's profile of EXA files keeps them
// (docs/exa.md, "The paper's profile").

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace dubsar {

class BitWriter {
 public:
  /// The lowest `count` (0..56) bits of a number whose other bits are 0.
  void bits(std::uint64_t value, int count) {
    pending_ |= value << held_;
    for (held_ += count; held_ >= 8; held_ -= 8, pending_ >>= 8) bytes_.push_back(static_cast<char>(pending_ & 255));
  }
  /// 7 bits in every 8, lowest first; the eighth says that more follow.
  void number(std::uint64_t n) {
    for (; n >= 128; n >>= 7) bits((n & 127) | 128, 8);
    bits(n, 8);
  }
  /// Zeros up to a whole number of `bytes` bytes.
  void pad_to(std::size_t bytes) {
    if (held_ > 0) bits(0, 8 - held_);
    bytes_.resize((bytes_.size() + bytes - 1) / bytes * bytes);
  }
  std::string take() {
    pad_to(1);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
  std::uint64_t pending_ = 0;
  int held_ = 0;  ///< bits of pending_
};

/// Behind the end there are zeros; past_end() tells.
class BitReader {
 public:
  explicit BitReader(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t bits(int count) {
    for (; held_ < count; held_ += 8, ++at_)
      if (at_ < bytes_.size()) pending_ |= std::uint64_t{static_cast<unsigned char>(bytes_[at_])} << held_;
    const std::uint64_t value = pending_ & ((std::uint64_t{1} << count) - 1);
    pending_ >>= count;
    held_ -= count;
    return value;
  }
  std::uint64_t number() {
    std::uint64_t n = 0;
    for (int shift = 0; shift < 63; shift += 7) {
      const std::uint64_t byte = bits(8);
      n |= (byte & 127) << shift;
      if (byte < 128) break;
    }
    return n;
  }
  std::size_t bytes_used() const { return at_ - static_cast<std::size_t>(held_ / 8); }
  bool past_end() const { return bytes_used() > bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::uint64_t pending_ = 0;
  int held_ = 0;
};

}  // namespace dubsar
