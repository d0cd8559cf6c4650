#pragma once
// Numbers that people write, strictly: the whole text, decimal, finite. Nothing is skipped, cut off or rounded to 0.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace dubsar {

/// "12", "-3.5", "1e-3". None: empty, anything before or after the number, NaN, infinite, beyond a double.
std::optional<double> parse_number(std::string_view text) noexcept;

/// A whole number; none also for "1.0" and beyond an int.
std::optional<int> parse_whole(std::string_view text) noexcept;

/// Exactly N numbers with one `separator` between them: parse_numbers<3>("30,0,600").
template <std::size_t N>
std::optional<std::array<double, N>> parse_numbers(std::string_view text, char separator = ',') noexcept {
  std::array<double, N> out{};
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t end = i + 1 < N ? text.find(separator) : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = parse_number(text.substr(0, end));
    if (!number) return std::nullopt;
    out[i] = *number;
    text.remove_prefix(i + 1 < N ? end + 1 : end);
  }
  return out;
}

/// "WIDTHxHEIGHT" in whole numbers.
std::optional<std::array<int, 2>> parse_size(std::string_view text) noexcept;

}  // namespace dubsar
