#pragma once
// Which display, with which options: what "NAME:word,key=value" says. Parsed once, printed back as the same.

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/text/option_list.h"

namespace dubsar {

using SinkOption = Option;

struct SinkSpec {
  std::string name;
  std::vector<SinkOption> options{};

  /// "NAME:word,key=value"; words and values with a comma, a quotation mark or an equals sign in a word stand in
  /// quotation marks, with a backslash before each quotation mark and backslash. parse_sink_spec() reads it as equal.
  std::string text() const;
  /// The part after the colon.
  std::string options_text() const;
  bool operator==(const SinkSpec&) const = default;
};

/// Reads "NAME" or "NAME:OPTION,...". An option is a word or key=value; words and values may stand in quotation marks,
/// and hold commas then. A colon ends the name, later ones belong to values. Order is kept, and options given twice
/// are. kUsage, with the place, for an empty name or option and for quotation marks that do not end or end early.
Result<SinkSpec> parse_sink_spec(std::string_view text);

}  // namespace dubsar
