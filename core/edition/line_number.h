#pragma once
// Numbers of lines, as editions and ATF have them: 3, 3', 3a, a+3', 1-2.

#include <string>
#include <string_view>

namespace dubsar {

/// [letter +] digits [primes] [letter], or two of them with - between: what CDLI, ORACC and eBL read. Primes may be '
/// or the typographic ones.
bool is_line_number(std::string_view text);

/// Of the line below: 4 of 3, 4' of 3', 4' of 3'a, 3 of 1-2. "1" of what is no number.
std::string next_line_number(std::string_view text);

/// Lines in their order: by digits, then what follows them; what is no number stands last.
bool is_line_before(std::string_view a, std::string_view b);

/// 1 to 3999 in small roman numerals, and back; empty and 0 where there is none.
std::string roman_number(int number);
int number_of_roman(std::string_view text);

}  // namespace dubsar
