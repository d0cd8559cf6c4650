#pragma once

#include <string>
#include <string_view>

namespace dubsar {

/// UTF-8 as text or as a quoted attribute of XML and HTML; control characters, which XML cannot hold, are left out.
std::string markup_text(std::string_view text);

}  // namespace dubsar
