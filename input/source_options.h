#pragma once
// Reading the options of sources that play a file.

#include <string>
#include <string_view>

#include "core/base/files/atomic_file.h"
#include "input/input_source.h"

namespace dubsar {

/// The file of "NAME:FILE" or "NAME:path=FILE": kUsage when there is none or anything else.
inline Result<std::string> only_path_option(const InputConfig& config, std::string_view source) {
  if (config.options.size() == 1) {
    const Option& option = config.options.front();
    if (option.key == "path" && !option.value.value_or("").empty()) return *option.value;
    if (option.key != "path" && !option.value) return option.key;
  }
  return fail(ErrorKind::kUsage, "input {}: expected one file, as {}:FILE", source, source);
}

inline Result<std::string> read_source_text(const std::string& path) {
  return read_text_file(path, std::int64_t{8} << 20);
}

}  // namespace dubsar
