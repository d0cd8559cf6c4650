#pragma once
// Hebrew, Arabic and their relatives as they are seen: letters joined, in the order in which they stand from left to
// right, for whoever draws one letter after the other. By GNU FriBidi: Unicode's bidirectional algorithm (UAX 9) and
// the joining of Arabic letters. Marks of vowels stand behind their letter, nobody places them.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace dubsar::app {

/// Whether a text has letters that are written from right to left.
bool has_right_to_left(std::string_view text);

/// A line in UTF-8 as it is seen; as it is, where has_right_to_left() says no. `right_to_left`: the line begins at the
/// right, whatever its first letter is.
std::string as_seen(std::string_view line, bool right_to_left);

/// A text as lines that are seen so, broken between words, each as long as `fits` says; a word that is too long has a
/// line of its own. No words: no lines.
std::vector<std::string> lines_as_seen(std::string_view text, bool right_to_left,
                                       const std::function<bool(const std::string&)>& fits);

}  // namespace dubsar::app
