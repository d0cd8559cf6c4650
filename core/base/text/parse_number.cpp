#include "core/base/text/parse_number.h"

#include <charconv>
#include <cmath>

namespace dubsar {
namespace {

template <class Number>
std::optional<Number> whole_text(std::string_view text) noexcept {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) noexcept {
  const auto value = whole_text<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<int> parse_whole(std::string_view text) noexcept { return whole_text<int>(text); }

std::optional<std::array<int, 2>> parse_size(std::string_view text) noexcept {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto width = parse_whole(text.substr(0, cross)), height = parse_whole(text.substr(cross + 1));
  if (!width || !height) return std::nullopt;
  return std::array{*width, *height};
}

}  // namespace dubsar
