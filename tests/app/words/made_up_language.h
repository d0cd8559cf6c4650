#pragma once
// A language that nobody speaks, made of the English table: each text is 40 % longer, with letters that English does
// not have, and stands in « and », so that what is drawn shows where it comes from and whether all of it is there.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "app/words/text.h"

namespace dubsar::app {

/// "«Ópén á súrfácé lóng»"; what stands in braces stays, and so does each form of those that count.
inline std::string made_up(std::string_view english) {
  std::string out = "\u00ab";
  std::size_t letters = 0;
  bool braces = false;
  for (const char c : english) {
    constexpr std::string_view kPlain = "aeiouAEIOU";
    constexpr std::array<const char*, 10> kAccented{"\u00e1", "\u00e9", "\u00ed", "\u00f3", "\u00fa",
                                                    "\u00c1", "\u00c9", "\u00cd", "\u00d3", "\u00da"};
    braces = c == '{' || (braces && c != '}');
    if (c == '|') {
      out += "\u00bb|\u00ab";
      continue;
    }
    const std::size_t at = braces ? std::string_view::npos : kPlain.find(c);
    out += at == std::string_view::npos ? std::string(1, c) : kAccented[at];
    ++letters;
  }
  for (std::size_t more = 0; 10 * more < 4 * letters; more += 5) out += " l\u00f3\u00f1g";
  return out + "\u00bb";
}

/// The file of that language, without some of the table's texts if `all` is false.
inline std::string made_up_file() {
  nlohmann::json out{{"language.name", "«»"}};
  for (const TextRow& row : kEnglish)
    if (!row.id.starts_with("language.")) out[std::string(row.id)] = made_up(row.text);
  return out.dump(1);
}

}  // namespace dubsar::app
