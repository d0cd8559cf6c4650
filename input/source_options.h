#pragma once
// Reading the options of sources that play a file.

#include <string>
#include <string_view>

#include "core/base/atomic_file.h"
#include "input/input_source.h"

namespace dubsar {

/// The file of "NAME:FILE" or "NAME:path=FILE": kUsage when there is none or anything else.
inline Result<std::string> only_path_option(const InputConfig& config, std::string_view source) {
  if (config.options.size() == 1) {
    const auto& [key, value] = config.options.front();
    if (key == "path" && !value.empty()) return value;
    if (!key.empty() && value.empty() && key != "path") return key;
  }
  return fail(ErrorKind::kUsage, "input {}: expected one file, as {}:FILE", source, source);
}

inline Result<std::string> read_source_text(const std::string& path) {
  return read_text_file(path, std::int64_t{8} << 20);
}

}  // namespace dubsar
