#pragma once
// Which source of input, with which options: what "NAME:word,key=value" says. Parsed once, printed back as the same.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text/option_list.h"

namespace dubsar {

struct SourceSpec {
  std::string name;
  std::vector<Option> options{};

  /// parse_source() reads it as equal.
  std::string text() const;
  bool operator==(const SourceSpec&) const = default;
};

/// "NAME" or "NAME:OPTIONS" (core/base/text/option_list.h): the first colon ends the name, later ones belong to values,
/// such as IPv6 addresses and /dev/v4l/by-path. kUsage.
Result<SourceSpec> parse_source(std::string_view text);

/// Several of them with commas between, as after --input. A word begins a source when it is the first, has a colon
/// before any equals sign, or is one of `names`; other words are options of the source before them.
Result<std::vector<SourceSpec>> parse_sources(std::string_view text, std::span<const std::string_view> names);

}  // namespace dubsar
