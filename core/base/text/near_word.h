#pragma once
// Slips of the finger: which word may have been meant.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dubsar {

/// The word of `known` that is nearest to `word`: letters inserted, left out, changed or exchanged with a neighbour, at
/// most one in a word of up to four letters, two in longer ones, case not counted; or the only one that begins with
/// `word` (three letters at least). Empty: none is near. The first of several.
std::string near_word(std::string_view word, std::span<const std::string> known);

/// "; did you mean \"raking\"?" to end a sentence with, or nothing. `known`: "relief, phong, raking".
std::string did_you_mean(std::string_view word, std::span<const std::string> known);
std::string did_you_mean(std::string_view word, std::string_view known);

}  // namespace dubsar
