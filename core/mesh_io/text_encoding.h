#pragma once
// Text as editors and web servers leave it: byte order marks, UTF-16 and UTF-32, pages in the place of files.

#include <string>
#include <string_view>

namespace dubsar {

/// Without the byte order mark of UTF-8; UTF-16, with its mark or with every other byte of the beginning 0, and UTF-32
/// with its mark as UTF-8. What is not well-formed becomes U+FFFD. Other bytes as they are.
std::string utf8_bytes(std::string bytes);

/// Begins as a page of the web or another XML document does.
bool is_web_page(std::string_view bytes);

}  // namespace dubsar
