#pragma once
// Adaptive binary range coder (Martin 1979; carry handling as in LZMA). Integers only, so the same bytes everywhere.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace dubsar {

/// Probability that a bit is 1, learnt as the mean of what was seen, later as a slow moving average.
class AdaptiveBit {
 public:
  /// 15-bit probability of a 1, never certain.
  std::uint32_t probability() const noexcept { return std::clamp<std::uint32_t>(p_ >> 7, kLeast, kOne - kLeast); }
  void learn(bool bit) noexcept {
    const std::int64_t target = bit ? (1 << 22) - 1 : 0;
    p_ = static_cast<std::uint32_t>(p_ + (target - p_) * kRate[seen_] / 65536);
    if (seen_ + 1 < kLimit) ++seen_;
  }
  static constexpr std::uint32_t kOne = 1 << 15;

 private:
  static constexpr std::uint32_t kLeast = 4;
  static constexpr int kLimit = 160;  // tuned on spheres and a noisy phantom: 60 to 250 differ by less than 1 %
  static constexpr std::array<std::int32_t, kLimit> kRate = [] {
    std::array<std::int32_t, kLimit> rate{};
    for (int n = 0; n < kLimit; ++n) rate[static_cast<std::size_t>(n)] = 65536 * 2 / (2 * n + 3);
    return rate;
  }();
  std::uint32_t p_ = 1 << 21;  // 22 bits
  std::uint8_t seen_ = 0;
};

class RangeEncoder {
 public:
  void code(AdaptiveBit& model, bool bit) {
    const std::uint32_t bound = (range_ / AdaptiveBit::kOne) * model.probability();
    if (bit) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    model.learn(bit);
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      shift_low();
    }
  }
  std::string take() {
    for (int i = 0; i < 5; ++i) shift_low();
    return std::move(bytes_);
  }

 private:
  void shift_low() {
    if (low_ < 0xFF000000u || low_ > 0xFFFFFFFFu) {
      const auto carry = static_cast<unsigned>(low_ >> 32);
      bytes_.push_back(static_cast<char>(cache_ + carry));
      for (; pending_ > 0; --pending_) bytes_.push_back(static_cast<char>(0xFF + carry));
      cache_ = static_cast<std::uint8_t>(low_ >> 24);
    } else {
      ++pending_;
    }
    low_ = (low_ & 0x00FFFFFFu) << 8;
  }
  std::string bytes_;
  std::uint64_t low_ = 0, pending_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
  std::uint8_t cache_ = 0;
};

/// Decodes what RangeEncoder wrote. Damaged bytes give wrong bits, never a read outside; past the end come zeros.
class RangeDecoder {
 public:
  explicit RangeDecoder(std::string_view bytes) noexcept : bytes_(bytes) {
    for (int i = 0; i < 5; ++i) code_ = code_ << 8 | next();
  }
  bool decode(AdaptiveBit& model) noexcept {
    const std::uint32_t bound = (range_ / AdaptiveBit::kOne) * model.probability();
    const bool bit = code_ < bound;
    if (bit) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    model.learn(bit);
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
    return bit;
  }
  bool past_end() const noexcept { return used_ > bytes_.size(); }
  /// True when exactly all bytes were used, as after decoding a whole undamaged stream.
  bool at_end() const noexcept { return used_ == bytes_.size(); }

 private:
  std::uint32_t next() noexcept {
    const std::size_t at = used_++;
    return at < bytes_.size() ? static_cast<unsigned char>(bytes_[at]) : 0u;
  }
  std::string_view bytes_;
  std::size_t used_ = 0;
  std::uint32_t code_ = 0, range_ = 0xFFFFFFFFu;
};

}  // namespace dubsar
