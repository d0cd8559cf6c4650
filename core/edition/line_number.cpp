#include "core/edition/line_number.h"

#include <array>
#include <charconv>
#include <optional>
#include <tuple>
#include <utility>

namespace dubsar {
namespace {

constexpr std::array<std::string_view, 4> kLinePrimes{"'", "\u2032", "\u2019", "\u02be"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct NumberParts {
  std::string before;  ///< "a+"
  int number = 0;
  int primes = 0;
  std::string letter;
};

/// One number at the beginning of the text, which is shortened by it.
std::optional<NumberParts> take_number(std::string_view& text) {
  NumberParts out;
  if (text.size() > 1 && is_letter(text[0]) && text[1] == '+') {
    out.before = text.substr(0, 2);
    text.remove_prefix(2);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.number);
  if (error != std::errc() || text.empty() || !is_digit(text[0])) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  for (bool found = true; found;) {
    found = false;
    for (const std::string_view prime : kLinePrimes)
      if (text.starts_with(prime)) {
        text.remove_prefix(prime.size());
        ++out.primes;
        found = true;
      }
  }
  if (!text.empty() && is_letter(text[0])) {
    out.letter = text.substr(0, 1);
    text.remove_prefix(1);
  }
  return out;
}

/// The last one of a range.
std::optional<NumberParts> last_number(std::string_view text) {
  auto out = take_number(text);
  if (out && text.starts_with("-")) {
    text.remove_prefix(1);
    out = take_number(text);
  }
  return text.empty() ? out : std::nullopt;
}

}  // namespace

bool is_line_number(std::string_view text) { return last_number(text).has_value(); }

std::string next_line_number(std::string_view text) {
  const auto last = last_number(text);
  if (!last) return "1";
  return last->before + std::to_string(last->number + 1) + std::string(static_cast<std::size_t>(last->primes), '\'');
}

bool is_line_before(std::string_view a, std::string_view b) {
  const auto key = [](std::string_view text) {
    const std::string whole(text);
    const auto first = take_number(text);
    return first ? std::tuple(0, first->primes > 0 ? 1 : 0, first->number, first->letter, whole)
                 : std::tuple(1, 0, 0, std::string(), whole);
  };
  return key(a) < key(b);
}

std::string roman_number(int number) {
  constexpr std::array<std::pair<int, const char*>, 13> kRomans{{{1000, "m"},
                                                                 {900, "cm"},
                                                                 {500, "d"},
                                                                 {400, "cd"},
                                                                 {100, "c"},
                                                                 {90, "xc"},
                                                                 {50, "l"},
                                                                 {40, "xl"},
                                                                 {10, "x"},
                                                                 {9, "ix"},
                                                                 {5, "v"},
                                                                 {4, "iv"},
                                                                 {1, "i"}}};
  std::string out;
  if (number > 3999) return out;
  for (const auto& [value, letters] : kRomans)
    for (; number >= value; number -= value) out += letters;
  return out;
}

int number_of_roman(std::string_view text) {
  if (text.empty()) return 0;
  for (int number = 1; number <= 3999; ++number)  // there are few, and each is written in one way
    if (roman_number(number) == text) return number;
  return 0;
}

}  // namespace dubsar
