#pragma once
// What is wrong with a text that is no JSON, and where: for people who write their files by hand.

#include <string>
#include <string_view>

namespace dubsar {

/// "line 6, column 3: a comma is missing before "objects"". Lines and columns (characters) count from 1; LF, CR LF and
/// CR end a line. "the file is empty", "the text is UTF-16, ..." where there is no place to name. For a text that the
/// parser refused; where nothing is found, its own place: byte `refused_at`, counted from 1.
std::string json_fault(std::string_view text, std::size_t refused_at);

}  // namespace dubsar
