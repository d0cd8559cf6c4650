#pragma once
// Lengths and sizes with units. Inside dubsar a length is a double with its unit in the name.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// Millimetres in one unit: "m" "cm" "mm" "um" "µm" "micron" "micrometer" "nm" "inch" and spellings of these.
std::optional<double> mm_per_unit(std::string_view unit);

/// "38um", "0.038 mm", "3.8e-5m" to millimetres. A number without a unit is refused: units are never guessed.
Result<double> parse_length_mm(std::string_view text);

/// "6G", "6 GiB", "512M", "1.5T": powers of 1024; a number without a unit is bytes. kUsage for what is no size, and for
/// less than one byte or more than 2^60.
Result<std::uint64_t> parse_bytes(std::string_view text);

/// Bytes in the units that sizes are said in.
template <class Count>
constexpr double gib_of(Count bytes) noexcept {
  return static_cast<double>(bytes) / 1073741824.0;
}
template <class Count>
constexpr double mib_of(Count bytes) noexcept {
  return static_cast<double>(bytes) / 1048576.0;
}

/// "746 MiB", "1.5 GiB".
std::string memory_text(double bytes);

}  // namespace dubsar
