#pragma once
// Brackets of a transliterated line: [ ] broken, half brackets damaged, ( ) perhaps, { } what is not read aloud, < >
// supplied, << >> to be left out. Each is closed in the line that it was opened in.

#include <string>
#include <string_view>
#include <vector>

namespace dubsar {

struct BracketFault {
  std::size_t column = 0;  ///< in characters, from 1
  std::string bracket;     ///< as it stands there
  enum class Kind { kNotClosed, kNotOpened, kNested } kind = Kind::kNotClosed;
  friend bool operator==(const BracketFault&, const BracketFault&) = default;
};

/// In the order of columns. Pairs may overlap, and square, half and pointed brackets may not stand in their own kind.
std::vector<BracketFault> bracket_faults(std::string_view text);

/// The text with closing brackets at its end for those that are open, the last one first, and opening ones at its
/// beginning. Brackets within their own kind stay as they are.
std::string with_brackets_closed(std::string_view text);

/// Whether something in the line is said to be broken or damaged: it has a square or half bracket, or a # behind a
/// sign.
bool tells_damage(std::string_view text);

/// Characters of UTF-8 before a byte of the text; a byte that belongs to none counts as one.
std::size_t characters_before(std::string_view text, std::size_t byte);

}  // namespace dubsar
