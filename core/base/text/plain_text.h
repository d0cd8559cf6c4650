#pragma once
// Names from files are not trusted: a terminal obeys escape sequences, and text that turns the writing direction hides
// what a name says.

#include <string>
#include <string_view>

namespace dubsar {

/// The text in printable UTF-8: control characters, characters that steer the direction of writing and bytes that are
/// not UTF-8 are written as \x1b or \u202e. With `keep_newlines` line ends stay; everything else is one line. Equal
/// to the text when there is nothing to replace.
std::string plain_text(std::string_view text, bool keep_newlines = false);

}  // namespace dubsar
