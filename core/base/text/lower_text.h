#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace dubsar {

/// A to Z as a to z; all other bytes stay, whatever the locale.
inline std::string lower_text(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

}  // namespace dubsar
