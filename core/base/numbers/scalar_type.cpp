#include "core/base/numbers/scalar_type.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "core/base/text/lower_text.h"

namespace dubsar {
namespace {

struct Half {
  std::uint16_t bits;
};

float half_to_float(std::uint16_t half) noexcept {
  const int exponent = (half >> 10) & 31;
  const auto fraction = static_cast<float>(half & 1023);
  float value = 0.0F;
  if (exponent == 31)
    value = fraction == 0.0F ? INFINITY : NAN;
  else if (exponent == 0)
    value = std::ldexp(fraction, -24);
  else
    value = std::ldexp(fraction + 1024.0F, exponent - 25);
  return (half & 0x8000) != 0 ? -value : value;
}

template <class T, bool kSwap>
T load(const std::byte* from) noexcept {
  using Bits = std::conditional_t<sizeof(T) == 1, std::uint8_t,
                                  std::conditional_t<sizeof(T) == 2, std::uint16_t,
                                                     std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;
  Bits bits;
  std::memcpy(&bits, from, sizeof bits);
  if constexpr (kSwap) {
    if constexpr (sizeof(T) == 2) bits = __builtin_bswap16(bits);
    if constexpr (sizeof(T) == 4) bits = __builtin_bswap32(bits);
    if constexpr (sizeof(T) == 8) bits = __builtin_bswap64(bits);
  }
  return std::bit_cast<T>(bits);
}

template <class T, bool kSwap>
void convert(const std::byte* from, const ScalarMap& map, std::span<float> out) noexcept {
  const auto number = [&](std::size_t i) {
    const T value = load<T, kSwap>(from + i * sizeof(T));
    if constexpr (std::is_same_v<T, Half>)
      return half_to_float(value.bits);
    else
      return value;
  };
  if (map.identity())
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(number(i));
  else if (!map.none.any())
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = static_cast<float>(static_cast<double>(number(i)) * map.scale + map.offset);
  else
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto stored = static_cast<double>(number(i));
      out[i] = map.none.is(stored) ? NAN : static_cast<float>(stored * map.scale + map.offset);
    }
}

template <class T>
void convert(const std::byte* from, bool swap, const ScalarMap& map, std::span<float> out) noexcept {
  if (swap && sizeof(T) > 1)
    convert<T, true>(from, map, out);
  else
    convert<T, false>(from, map, out);
}

}  // namespace

std::string_view scalar_name(ScalarType type) noexcept {
  static constexpr std::array<std::string_view, 11> kNames{"uint8",  "int8",  "uint16",  "int16",   "uint32", "int32",
                                                           "uint64", "int64", "float16", "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

std::int64_t scalar_bytes(ScalarType type) noexcept {
  static constexpr std::array<std::int64_t, 11> kBytes{1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

std::string_view order_name(ByteOrder order) noexcept { return order == ByteOrder::kBig ? "big" : "little"; }

std::optional<ScalarType> parse_scalar_type(std::string_view text) {
  using enum ScalarType;
  static constexpr std::array<std::pair<std::string_view, ScalarType>, 71> kSpellings{{
      {"u8", kU8},
      {"u1", kU8},
      {"uint8", kU8},
      {"uint8_t", kU8},
      {"uchar", kU8},
      {"unsigned char", kU8},
      {"byte", kU8},
      {"i8", kI8},
      {"i1", kI8},
      {"int8", kI8},
      {"int8_t", kI8},
      {"signed char", kI8},
      {"char", kI8},
      {"u16", kU16},
      {"u2", kU16},
      {"uint16", kU16},
      {"uint16_t", kU16},
      {"ushort", kU16},
      {"unsigned short", kU16},
      {"unsigned short int", kU16},
      {"i16", kI16},
      {"i2", kI16},
      {"int16", kI16},
      {"int16_t", kI16},
      {"short", kI16},
      {"short int", kI16},
      {"signed short", kI16},
      {"signed short int", kI16},
      {"u32", kU32},
      {"u4", kU32},
      {"uint32", kU32},
      {"uint32_t", kU32},
      {"uint", kU32},
      {"unsigned int", kU32},
      {"unsigned", kU32},
      {"i32", kI32},
      {"i4", kI32},
      {"int32", kI32},
      {"int32_t", kI32},
      {"int", kI32},
      {"signed int", kI32},
      {"u64", kU64},
      {"uint64", kU64},
      {"uint64_t", kU64},
      {"ulonglong", kU64},
      {"unsigned long long", kU64},
      {"unsigned long long int", kU64},
      {"i64", kI64},
      {"int64", kI64},
      {"int64_t", kI64},
      {"longlong", kI64},
      {"long long", kI64},
      {"long long int", kI64},
      {"signed long long", kI64},
      {"signed long long int", kI64},
      {"f16", kF16},
      {"f2", kF16},
      {"float16", kF16},
      {"half", kF16},
      {"f32", kF32},
      {"f4", kF32},
      {"float32", kF32},
      {"float", kF32},
      {"single", kF32},
      {"real", kF32},
      {"f64", kF64},
      {"f8", kF64},
      {"float64", kF64},
      {"double", kF64},
      {"double precision", kF64},
  }};
  const std::string lower = lower_text(text);
  for (const auto& [name, type] : kSpellings)
    if (lower == name) return type;
  return std::nullopt;
}

void scalars_to_float(const std::byte* from, ScalarType type, ByteOrder order, const ScalarMap& map,
                      std::span<float> out) noexcept {
  const bool swap = order != kNativeOrder;
  switch (type) {
    case ScalarType::kU8:
      return convert<std::uint8_t>(from, swap, map, out);
    case ScalarType::kI8:
      return convert<std::int8_t>(from, swap, map, out);
    case ScalarType::kU16:
      return convert<std::uint16_t>(from, swap, map, out);
    case ScalarType::kI16:
      return convert<std::int16_t>(from, swap, map, out);
    case ScalarType::kU32:
      return convert<std::uint32_t>(from, swap, map, out);
    case ScalarType::kI32:
      return convert<std::int32_t>(from, swap, map, out);
    case ScalarType::kU64:
      return convert<std::uint64_t>(from, swap, map, out);
    case ScalarType::kI64:
      return convert<std::int64_t>(from, swap, map, out);
    case ScalarType::kF16:
      return convert<Half>(from, swap, map, out);
    case ScalarType::kF32:
      return convert<float>(from, swap, map, out);
    case ScalarType::kF64:
      return convert<double>(from, swap, map, out);
  }
}

}  // namespace dubsar
