#pragma once
// What is wrong with a text that is no JSON, and where: for people who write their files by hand.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dubsar {

/// "line 6, column 3: a comma is missing before "objects"". Lines and columns (characters) count from 1; LF, CR LF and
/// CR end a line. "the file is empty", "the text is UTF-16, ..." where there is no place to name. For a text that the
/// parser refused; where nothing is found, its own place: byte `refused_at`, counted from 1.
std::string json_fault(std::string_view text, std::size_t refused_at);

/// What of a kind a fault is, for those that can tell how it is mended (json_mend.h).
enum class JsonSlip : std::uint8_t {
  kOther,
  kBytes,
  kTail,
  kComment,
  kQuote,
  kCommaTooMany,
  kCommaMissing,
  kSemicolon,
  kDecimalComma,
  kEquals,
  kColonMissing,
  kBareName,
  kWord,
  kNumber,
  kBackslash,
  kControl,
  kOpenText,
  kOpenEnd
};
struct JsonFault {
  std::size_t at = 0;  ///< byte, from 0 on
  std::string what{};  ///< without its place
  JsonSlip slip = JsonSlip::kOther;
};
/// The first one that a strict reader meets; none: it is JSON, but for numbers and depths that a parser refuses.
std::optional<JsonFault> first_json_fault(std::string_view text);

/// "line 6, column 3", of a byte.
std::string json_place(std::string_view text, std::size_t at);

}  // namespace dubsar
