#pragma once
// The number types that volume files store, and their conversion to float.

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace dubsar {

enum class ScalarType : std::uint8_t { kU8, kI8, kU16, kI16, kU32, kI32, kU64, kI64, kF16, kF32, kF64 };
enum class ByteOrder : std::uint8_t { kLittle, kBig };

constexpr ByteOrder kNativeOrder = std::endian::native == std::endian::big ? ByteOrder::kBig : ByteOrder::kLittle;

/// "uint8" ... "float64".
std::string_view scalar_name(ScalarType type) noexcept;
std::int64_t scalar_bytes(ScalarType type) noexcept;
constexpr bool is_float(ScalarType type) noexcept { return type >= ScalarType::kF16; }

/// Understands the spellings of numpy ("uint16", "u2"), NRRD ("unsigned short", "ushort") and short ones ("u16", "f32",
/// "float"). Case does not matter.
std::optional<ScalarType> parse_scalar_type(std::string_view text);

/// "little" or "big".
std::string_view order_name(ByteOrder order) noexcept;

template <class T>
constexpr ScalarType scalar_type_of() {
  if constexpr (std::same_as<T, std::uint8_t>) return ScalarType::kU8;
  if constexpr (std::same_as<T, std::int8_t>) return ScalarType::kI8;
  if constexpr (std::same_as<T, std::uint16_t>) return ScalarType::kU16;
  if constexpr (std::same_as<T, std::int16_t>) return ScalarType::kI16;
  if constexpr (std::same_as<T, std::uint32_t>) return ScalarType::kU32;
  if constexpr (std::same_as<T, std::int32_t>) return ScalarType::kI32;
  if constexpr (std::same_as<T, std::uint64_t>) return ScalarType::kU64;
  if constexpr (std::same_as<T, std::int64_t>) return ScalarType::kI64;
  if constexpr (std::same_as<T, float>) return ScalarType::kF32;
  if constexpr (std::same_as<T, double>) return ScalarType::kF64;
}

/// Stored numbers that are no measurement (_FillValue, missing_value, valid_range of a file).
struct NoMeasurement {
  static constexpr int kMost = 8;
  std::array<double, kMost> values{};  ///< each of the first `count`
  int count = 0;
  double least = -std::numeric_limits<double>::infinity();  ///< and everything below
  double most = std::numeric_limits<double>::infinity();    ///< and everything above
  bool any() const noexcept { return count > 0 || least > -HUGE_VAL || most < HUGE_VAL; }
  bool is(double stored) const noexcept {
    bool found = stored < least || stored > most;
    for (int i = 0; i < count; ++i) found = found || stored == values[static_cast<std::size_t>(i)];
    return found;
  }
};

/// Stored value -> meaning: value * scale + offset (scale_factor, add_offset of the file), NaN for what is no
/// measurement.
struct ScalarMap {
  double scale = 1.0;
  double offset = 0.0;
  NoMeasurement none{};
  bool identity() const noexcept { return scale == 1.0 && offset == 0.0 && !none.any(); }
};

/// Converts out.size() stored numbers at `from` (any alignment) to float, rounding to nearest. The map is applied in
/// double. One thread; about memory speed.
void scalars_to_float(const std::byte* from, ScalarType type, ByteOrder order, const ScalarMap& map,
                      std::span<float> out) noexcept;

}  // namespace dubsar
