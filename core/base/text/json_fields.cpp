#include "core/base/text/json_fields.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace dubsar {
using nlohmann::json;

const json* JsonFields::find(const char* name) const {
  if (!has(name)) return nullptr;
  const json& value = object_->at(name);
  return value.is_object() && value.contains("value") ? &value.at("value") : &value;
}

void JsonFields::complain(std::string sentence, std::string_view member) {
  complaints_.push_back({std::string(member), std::move(sentence)});
}

double JsonFields::number(const char* name, double low, double high, const double* fallback) {
  const json* const value = find(name);
  if (value == nullptr) {
    if (fallback != nullptr) return *fallback;
    complain(fmt::format("{} is missing, expected a number of {} to {}", name, low, high), name);
    return low;
  }
  if (!value->is_number()) {
    complain(fmt::format("{} is {}, expected a number of {} to {}", name, value->type_name(), low, high), name);
    return low;
  }
  const double found = value->get<double>();
  if (!std::isfinite(found) || found < low || found > high) {
    complain(fmt::format("{} is {}, expected {} to {}", name, found, low, high), name);
    return low;
  }
  return found;
}

int JsonFields::integer(const char* name, int low, int high, const int* fallback) {
  const double as_double = fallback != nullptr ? *fallback : 0.0;
  const double found = number(name, low, high, fallback != nullptr ? &as_double : nullptr);
  if (found != std::floor(found)) complain(fmt::format("{} is {}, expected a whole number", name, found), name);
  return static_cast<int>(found);
}

bool JsonFields::flag(const char* name, bool fallback) {
  const json* const value = find(name);
  if (value == nullptr) return fallback;
  if (value->is_boolean()) return value->get<bool>();
  if (value->is_number()) return value->get<double>() >= 0.5;
  complain(fmt::format("{} is {}, expected true, false, 0 or 1", name, value->type_name()), name);
  return fallback;
}

std::string JsonFields::text(const char* name, const char* fallback) {
  const json* const value = find(name);
  if (value == nullptr) {
    if (fallback != nullptr) return fallback;
    complain(fmt::format("{} is missing, expected a text", name), name);
    return {};
  }
  if (value->is_string()) return value->get<std::string>();
  if (value->is_number()) return value->dump();
  complain(fmt::format("{} is {}, expected a text", name, value->type_name()), name);
  return {};
}

const json& JsonFields::list(const char* name, std::size_t most) {
  static const json kEmpty = json::array();
  if (!has(name)) return kEmpty;
  const json& value = object_->at(name);
  if (value.is_array() && value.size() <= most) return value;
  complain(fmt::format("{} is not a list of at most {} things", name, most), name);
  return kEmpty;
}

std::vector<std::string> JsonFields::texts(const char* name, std::size_t most) {
  std::vector<std::string> out;
  for (const json& item : list(name, most)) {
    if (item.is_string() && !item.get_ref<const std::string&>().empty())
      out.push_back(item.get<std::string>());
    else
      complain(fmt::format("\"{}\" holds something that is no text", name), name);
  }
  return out;
}

void JsonFields::only(std::span<const std::string_view> known) {
  if (!object_->is_object()) return complain(fmt::format("found {}, expected an object", object_->type_name()));
  for (const auto& [name, value] : object_->items())
    if (std::find(known.begin(), known.end(), std::string_view(name)) == known.end())
      complain(fmt::format("\"{}\" is unknown, expected one of: {}", name, fmt::join(known, ", ")), name);
}

Result<void> check_members(const json& object, std::span<const std::string_view> known, std::string where,
                           ErrorKind kind) {
  JsonFields fields(object, std::move(where));
  fields.only(known);
  return fields.finish(kind);
}

Result<void> check_list(const json& object, const char* name, std::size_t least, std::size_t most,
                        const std::string& where) {
  const bool fits = object.is_object() && object.contains(name) && object.at(name).is_array() &&
                    object.at(name).size() >= least && object.at(name).size() <= most;
  if (fits) return {};
  return fail(ErrorKind::kBadData, "{}: \"{}\" is no list of {} {} {}", where, name,
              least == 0 ? "at most" : fmt::format("{} to", least), most, name);
}

Result<void> JsonFields::finish(ErrorKind kind) const {
  if (!complaints_.empty()) return fail(kind, "{}: {}", where_, complaints_.front().sentence);
  return {};
}

}  // namespace dubsar
