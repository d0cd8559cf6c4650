#pragma once
// Small numbers through adaptive bits: the code parts that attributes, escapes and exact values share (docs/exa.md,
// "Numbers"). `Coder` is BitSink or BitSource, so that encoder and decoder are one function.

#include <array>
#include <cstdint>

#include "core/exa/coding/range_coder.h"

namespace dubsar {

struct BitSink {
  static constexpr bool kWrites = true;
  RangeEncoder& out;
  bool bit(AdaptiveBit& model, bool value) {
    out.bit(model, value);
    return value;
  }
  bool steady_bit(AdaptiveBit& model, bool value) { return bit(model, value); }
  std::uint32_t raw(std::uint32_t value, int count) {
    out.raw(value, count);
    return value;
  }
};
struct BitSource {
  static constexpr bool kWrites = false;
  RangeDecoder& in;
  [[gnu::always_inline]] bool bit(AdaptiveBit& model, bool) { return in.bit(model); }
  [[gnu::always_inline]] bool steady_bit(AdaptiveBit& model, bool) { return in.steady_bit(model); }
  std::uint32_t raw(std::uint32_t, int count) { return in.raw(count); }
};

/// The coder of a loop that codes much: what a decoder knows stays in registers until the loop ends.
template <class Coder>
struct NearCoder {
  explicit NearCoder(Coder& from) : coder(from) {}
  Coder& coder;
};
template <>
struct NearCoder<BitSource> {
  explicit NearCoder(BitSource& from) : home_(from.in), own_(from.in), coder{own_} {}
  ~NearCoder() { home_ = own_; }
  NearCoder(const NearCoder&) = delete;
  NearCoder& operator=(const NearCoder&) = delete;

 private:
  RangeDecoder& home_;
  RangeDecoder own_;

 public:
  BitSource coder;
};

/// A number of `Bits` bits, highest first, one model for each beginning.
template <int Bits>
class BitTree {
 public:
  template <class Coder>
  [[gnu::always_inline]] std::uint32_t code(Coder& coder, std::uint32_t value) {
    std::uint32_t node = 1;
    for (int b = Bits - 1; b >= 0; --b) node = node << 1 | (coder.bit(models_[node], (value >> b & 1) != 0) ? 1u : 0u);
    return node - (1u << Bits);
  }
  /// The same code, faster where all but the last bit are mostly alike.
  template <class Coder>
  [[gnu::always_inline]] std::uint32_t code_steady(Coder& coder, std::uint32_t value) {
    std::uint32_t node = 1;
    for (int b = Bits - 1; b > 1; --b)
      node = node << 1 | (coder.steady_bit(models_[node], (value >> b & 1) != 0) ? 1u : 0u);
    for (int b = 1; b >= 0; --b) node = node << 1 | (coder.bit(models_[node], (value >> b & 1) != 0) ? 1u : 0u);
    return node - (1u << Bits);
  }

 private:
  std::array<AdaptiveBit, std::size_t{1} << Bits> models_;
};

/// A signed number of at most 15 bits: its length in bits, then its sign, then the bits behind the highest.
class SignedNumber {
 public:
  template <class Coder>
  [[gnu::always_inline]] std::int32_t code(Coder& coder, std::int32_t value) {
    const std::uint32_t size = static_cast<std::uint32_t>(value < 0 ? -value : value);
    std::uint32_t length = 0;
    while (size >> length != 0) ++length;
    length = length_.code_steady(coder, length);
    if (length == 0) return 0;
    const bool negative = coder.bit(sign_, value < 0);
    const auto below = static_cast<int>(length) - 1;
    const std::uint32_t mask = (1u << below) - 1;
    std::uint32_t low = size & mask;
    if (below > 0) {
      const bool high = coder.bit(second_[length], (low >> (below - 1) & 1) != 0);
      low = coder.raw(low & (mask >> 1), below - 1) | (high ? 1u << (below - 1) : 0u);
    }
    const auto magnitude = static_cast<std::int32_t>(1u << below | low);
    return negative ? -magnitude : magnitude;
  }

 private:
  BitTree<4> length_;
  AdaptiveBit sign_;
  std::array<AdaptiveBit, 16> second_;
};

}  // namespace dubsar
