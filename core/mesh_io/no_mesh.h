#pragma once
// What lies under the name of a mesh file and is none.

#include <optional>
#include <string>
#include <string_view>

namespace dubsar {

/// What was found and what to do about it, such as "a ZIP archive found, expected a mesh; unpack it"; nothing where
/// the bytes may be a mesh. STL has no mark of its own, so that only marks that are no text of an STL count.
std::optional<std::string> what_is_no_mesh(std::string_view bytes);

/// Printable letters of ASCII, blanks and line ends alone.
bool is_plain_text(std::string_view bytes);

}  // namespace dubsar
