#pragma once
// Letters of transliterations as a keyboard has them, and as they are printed.

#include <string>
#include <string_view>

namespace dubsar {

/// The text of a line with sz as š, s, as ṣ, t, as ṭ, h, as ḫ, s' as ś, ' as ʾ at a word's beginning and between
/// vowels, capitals likewise; digits behind a letter of the same sign as subscripts (qi2), x as ₓ in lax(LA). Numbers
/// as 1(disz), names of signs as N57, modifiers as @180, languages as %akk and x in |KAxLA| stay. What is typed bit by
/// bit comes to the same: typed_letters(typed_letters(a) + b) is typed_letters(a + b).
std::string typed_letters(std::string_view text);

/// The way back, as C-ATF has it: š as sz, ṣ as s, and so on; of capitals Š as SZ beside another capital, else Sz. ḫ is
/// h there.
std::string ascii_letters(std::string_view text);

}  // namespace dubsar
