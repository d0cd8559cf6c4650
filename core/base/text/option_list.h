#pragma once
// Lists of options as people write them, "word,key=value,key="a,b"": read and printed back as the same.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

struct Option {
  std::string key;
  std::optional<std::string> value{};  ///< none: a bare word; empty: "key="
  bool operator==(const Option&) const = default;
};

/// Options with commas between. Words and values may stand in quotation marks, and hold commas, equals signs and (after
/// a backslash) quotation marks and backslashes then. Order is kept. An empty text has none. kUsage, with the place:
/// an empty option, quotation marks that do not end or end early; the sentence names `subject` and the `whole` text
/// that the options are a part of (empty: they are all of it).
Result<std::vector<Option>> parse_options(std::string_view text, std::string_view subject = "options",
                                          std::string_view whole = {});

/// parse_options() reads it as equal.
std::string options_text(const std::vector<Option>& options);

/// The parts of `text` between commas that stand in no quotation marks, as they are written.
std::vector<std::string_view> split_at_commas(std::string_view text);

}  // namespace dubsar
