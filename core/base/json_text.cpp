#include "core/base/json_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace dubsar {
namespace {
int nesting_depth(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}
}  // namespace

Result<nlohmann::json> parse_json(std::string_view text, std::string_view what) {
  if (text.size() > kJsonMaxBytes)
    return fail(ErrorKind::kBadData, "{}: JSON text of {} bytes found, expected at most {}", what, text.size(),
                kJsonMaxBytes);
  if (const int depth = nesting_depth(text); depth > kJsonMaxDepth)
    return fail(ErrorKind::kBadData, "{}: JSON is nested {} deep, expected at most {}", what, depth, kJsonMaxDepth);
  nlohmann::json parsed = nlohmann::json::parse(text, nullptr, false);
  if (parsed.is_discarded()) return fail(ErrorKind::kBadData, "{}: the JSON text is broken", what);
  return parsed;
}

std::string dump_json(const nlohmann::json& value) {
  return value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

std::string dump_json_lines(const nlohmann::json& value) {
  return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace dubsar
