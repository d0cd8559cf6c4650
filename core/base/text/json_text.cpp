#include "core/base/text/json_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/text/json_fault.h"

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
/// What stands in one line is appended to `out` by nlohmann's own dump().
void dump_rows(const nlohmann::json& value, const std::string& indent, std::string& out) {
  const bool row = value.is_array() &&
                   std::all_of(value.begin(), value.end(), [](const nlohmann::json& each) { return each.is_number(); });
  if (row || !value.is_structured() || value.empty()) {
    out += value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return;
  }
  const std::string inner(indent.size() + 1, ' ');
  const char* between = "";
  out += value.is_array() ? '[' : '{';
  for (const auto& [key, each] : value.items()) {
    out += std::exchange(between, ",");
    out.append("\n").append(inner);
    if (value.is_object())
      out += nlohmann::json(key).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + ": ";
    dump_rows(each, inner, out);
  }
  out.append("\n").append(indent);
  out += value.is_array() ? ']' : '}';
}

tl::unexpected<Error> broken(std::string_view text, std::string_view what, std::size_t refused_at) {
  const std::string fault = json_fault(text, refused_at);
  return fail(ErrorKind::kBadData, "{}{}{}", what, fault.starts_with("line ") ? ", " : ": ", fault);
}
}  // namespace

Result<nlohmann::json> parse_json(std::string_view text, std::string_view what, std::size_t max_bytes) {
  if (text.size() > max_bytes)
    return fail(ErrorKind::kBadData, "{}: JSON text of {} bytes found, expected at most {}", what, text.size(),
                max_bytes);
  if (const int depth = nesting_depth(text); depth > kJsonMaxDepth)
    return fail(ErrorKind::kBadData, "{}: JSON is nested {} deep, expected at most {}", what, depth, kJsonMaxDepth);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    return broken(text, what, error.byte);
  } catch (const nlohmann::json::out_of_range&) {
    return broken(text, what, 0);  // a number that no double holds
  }
}

Result<int> json_version(const nlohmann::json& object, std::string_view format, int oldest, int newest,
                         std::string_view what) {
  if (!object.is_object() || !object.contains("format") || object.at("format") != format)
    return fail(ErrorKind::kBadData, "{}: found other JSON, expected \"format\": \"{}\"", what, format);
  const nlohmann::json version = object.value("version", nlohmann::json("none"));
  if (version.is_number_integer() && version >= oldest && version <= newest) return version.get<int>();
  return fail(ErrorKind::kBadData, "{}: version {} found, expected {}; a newer dubsar may have written it", what,
              version == "none" ? "none" : dump_json(version),
              oldest == newest ? fmt::format("{}", newest) : fmt::format("{} to {}", oldest, newest));
}

std::string dump_json(const nlohmann::json& value) {
  return value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

std::string dump_json_lines(const nlohmann::json& value) {
  return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string dump_json_rows(const nlohmann::json& value) {
  std::string out;
  dump_rows(value, "", out);
  return out;
}

}  // namespace dubsar
