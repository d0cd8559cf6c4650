#pragma once
// Text that shows whether it is still what a program wrote: a sum over all of it stands in it.

#include <string>
#include <string_view>

namespace dubsar {

/// What a text to be sealed has in its first 4096 bytes; the first such place becomes the seal, of the same length.
inline constexpr std::string_view kUnsealed = "sum_0000000000000000";

/// `text` with the sum of all its bytes (FNV-1a, 64 bits, taken with kUnsealed in place) instead of the first
/// kUnsealed. Without one the text stays as it is. It shows changes by editors and people, not forgeries.
std::string sealed_text(std::string text);
/// Whether the first "sum_" and 16 hexadecimal digits in the first 4096 bytes is the sum of all bytes.
bool is_sealed_text(std::string_view text);

}  // namespace dubsar
