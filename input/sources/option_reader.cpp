#include "input/sources/option_reader.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "input/placement.h"

namespace dubsar {
namespace {

/// The whole text as a number.
std::optional<double> number_of(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

const std::string* OptionReader::find(std::string_view name) {
  known_ += (known_.empty() ? "" : ", ") + std::string(name);
  for (auto it = left_.begin(); it != left_.end(); ++it)
    if (it->first == name) {
      found_ = std::move(it->second);
      left_.erase(it);
      return &found_;
    }
  return nullptr;
}

void OptionReader::complain(std::string sentence) {
  if (complaint_.empty()) complaint_ = std::move(sentence);
}

std::string OptionReader::first_word() {
  if (left_.empty() || !left_.front().second.empty()) return {};
  std::string word = std::move(left_.front().first);
  left_.erase(left_.begin());
  return word;
}

bool OptionReader::flag(std::string_view name) {
  const std::string* const value = find(name);
  if (value && !value->empty()) complain(fmt::format("{} takes no value", name));
  return value != nullptr;
}

std::string OptionReader::text(std::string_view name, std::string_view fallback) {
  const std::string* const value = find(name);
  if (value && value->empty()) complain(fmt::format("{} needs a value", name));
  return value ? *value : std::string(fallback);
}

double OptionReader::number(std::string_view name, double low, double high, double fallback) {
  const std::string* const value = find(name);
  if (!value) return fallback;
  const auto parsed = number_of(*value);
  if (parsed && *parsed >= low && *parsed <= high) return *parsed;
  complain(fmt::format("{} is \"{}\", expected a number of {} to {}", name, *value, low, high));
  return fallback;
}

int OptionReader::integer(std::string_view name, int low, int high, int fallback) {
  const double value = number(name, low, high, fallback);
  if (value != std::floor(value)) complain(fmt::format("{} is {}, expected a whole number", name, value));
  return static_cast<int>(value);
}

glm::dvec3 OptionReader::triple(std::string_view name, double limit, const glm::dvec3& fallback) {
  const std::string* const value = find(name);
  if (!value) return fallback;
  glm::dvec3 out(0.0);
  std::string_view rest = *value;
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = rest.substr(0, i < 2 ? rest.find('/') : std::string_view::npos);
    const auto parsed = number_of(word);
    if (!parsed || std::abs(*parsed) > limit) {
      complain(fmt::format("{} is \"{}\", expected three numbers of {} to {} such as 0/-250/250", name, *value, -limit,
                           limit));
      return fallback;
    }
    out[i] = *parsed;
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
  }
  return out;
}

Pose OptionReader::placement(const Pose& fallback) {
  Pose out = fallback;
  for (const char* const name : {"at", "turn"}) {
    const std::string* const value = find(name);
    if (!value) continue;
    if (const auto read = read_placement(name, *value, out); !read) complain(read.error().message);
  }
  return out;
}

Result<void> OptionReader::finish() {
  if (complaint_.empty() && !left_.empty())
    complaint_ = fmt::format("\"{}\" is not an option, expected one of: {}", left_.front().first, known_);
  if (!complaint_.empty()) return fail(ErrorKind::kUsage, "input {}: {}", source_, complaint_);
  return {};
}

}  // namespace dubsar
