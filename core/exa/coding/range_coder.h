#pragma once
// Range coder (Martin 1979; carry handling as in LZMA) for bits and for symbols with given probabilities, and a bit
// whose probability is learnt. Integers only, so the same bytes everywhere (docs/exa.md, "Range coder").

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace dubsar {

/// Probabilities are 16-bit fractions: a share of kProbabilityOne that is never 0 and never all.
inline constexpr std::uint32_t kProbabilityOne = 1u << 16;

/// Probability that a bit is 1, learnt as the mean of what was seen, later as a slow moving average.
class AdaptiveBit {
 public:
  AdaptiveBit() = default;
  /// Starts at `p` (of 65536) as if `seen` bits had been seen.
  constexpr AdaptiveBit(std::uint32_t p, int seen) noexcept : p_(p << 6), seen_(static_cast<std::uint8_t>(seen)) {}
  [[gnu::always_inline]] std::uint32_t probability() const noexcept {
    const std::uint32_t p = p_ >> 6;
    return p < kLeast ? kLeast : p > kProbabilityOne - kLeast ? kProbabilityOne - kLeast : p;
  }
  [[gnu::always_inline]] void learn(bool bit) noexcept {
    const std::int64_t target = bit ? (1 << 22) - 1 : 0;
    p_ = static_cast<std::uint32_t>(p_ + (target - p_) * kRate[seen_] / 65536);
    if (seen_ + 1 < kLimit) ++seen_;
  }

 private:
  static constexpr std::uint32_t kLeast = 8;
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
  /// A bit that is 1 with probability p / 65536, 0 < p < 65536.
  void bit(std::uint32_t p, bool value) {
    const std::uint32_t bound = (range_ >> 16) * p;
    if (value) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    normalise();
  }
  void bit(AdaptiveBit& model, bool value) {
    bit(model.probability(), value);
    model.learn(value);
  }
  /// The symbol that holds [start, start + size) of 65536.
  void symbol(std::uint32_t start, std::uint32_t size) {
    range_ >>= 16;
    low_ += std::uint64_t{range_} * start;
    range_ *= size;
    normalise();
  }
  /// The lowest `count` (0..16) bits of a number, all equally likely.
  void raw(std::uint32_t value, int count) {
    if (count > 0) symbol(value << (16 - count), 1u << (16 - count));
  }
  /// All bytes: no more than are needed, as behind the end there are zeros.
  std::string take() {
    const std::uint64_t last = low_ + range_ - 1;
    for (int k = 31; k >= 0; --k) {
      const std::uint64_t mask = (std::uint64_t{1} << k) - 1, rounded = (low_ + mask) & ~mask;
      if (rounded > last) continue;
      low_ = rounded;
      break;
    }
    for (int i = 0; i < 5; ++i) shift_low();
    while (!bytes_.empty() && bytes_.back() == '\0') bytes_.pop_back();
    bytes_.erase(0, 1);  // the carry out of the first byte, always 0
    return std::move(bytes_);
  }

 private:
  void normalise() {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      shift_low();
    }
  }
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

/// Decodes what RangeEncoder wrote. Damaged bytes give wrong values, never a read outside; past the end come zeros.
class RangeDecoder {
 public:
  explicit RangeDecoder(std::string_view bytes) noexcept : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
  }
  [[gnu::always_inline]] bool bit(std::uint32_t p) noexcept {
    const std::uint32_t bound = (range_ >> 16) * p;
    const bool value = code_ < bound;
    const std::uint32_t above = std::uint32_t{value} - 1;  // all ones for a 0: no branch, it would be guessed wrong
    code_ -= bound & above;
    range_ = bound + ((range_ - 2 * bound) & above);
    normalise();
    return value;
  }
  [[gnu::always_inline]] bool bit(AdaptiveBit& model) noexcept {
    const bool value = bit(model.probability());
    model.learn(value);
    return value;
  }
  /// The same for bits that are mostly what was seen before: with a branch, which is then guessed right.
  [[gnu::always_inline]] bool steady_bit(AdaptiveBit& model) noexcept {
    const std::uint32_t bound = (range_ >> 16) * model.probability();
    const bool value = code_ < bound;
    if (value) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    normalise();
    model.learn(value);
    return value;
  }
  /// The place, 0..65535, that the next symbol holds; symbol() with its interval must follow.
  std::uint32_t place() noexcept {
    range_ >>= 16;
    const std::uint32_t at = code_ / range_;
    return at < kProbabilityOne ? at : kProbabilityOne - 1;
  }
  /// For who finds the symbol without a place: the share of 65536 that one of it has in code(), which the symbol's
  /// start, times this, does not exceed; symbol() must follow.
  std::uint32_t split() noexcept { return range_ >>= 16; }
  std::uint32_t code() const noexcept { return code_; }
  void symbol(std::uint32_t start, std::uint32_t size) noexcept {
    code_ -= range_ * start;
    range_ *= size;
    // Two bytes at most, without a branch, as in a third of all symbols there is one.
    const unsigned bytes = (range_ < (1u << 24) ? 1u : 0u) + (range_ < (1u << 16) ? 1u : 0u);
    code_ = code_ << (8 * bytes) | peek_two() >> (16 - 8 * bytes);
    range_ <<= 8 * bytes;
    used_ += bytes;
  }
  [[gnu::always_inline]] std::uint32_t raw(int count) noexcept {
    if (count == 0) return 0;
    const std::uint32_t value = place() >> (16 - count);
    symbol(value << (16 - count), 1u << (16 - count));
    return value;
  }

 private:
  [[gnu::always_inline]] void normalise() noexcept {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
  }
  [[gnu::always_inline]] std::uint32_t at(std::size_t i) const noexcept {
    return i < bytes_.size() ? static_cast<unsigned char>(bytes_[i]) : 0u;
  }
  [[gnu::always_inline]] std::uint32_t next() noexcept { return at(used_++); }
  std::uint32_t peek_two() const noexcept {
    if (used_ + 2 > bytes_.size()) return at(used_) << 8;
    return std::uint32_t{static_cast<unsigned char>(bytes_[used_])} << 8 |
           static_cast<unsigned char>(bytes_[used_ + 1]);
  }
  std::string_view bytes_;
  std::size_t used_ = 0;
  std::uint32_t code_ = 0, range_ = 0xFFFFFFFFu;
};

}  // namespace dubsar
