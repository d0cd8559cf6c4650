#include "core/base/text/option_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "core/base/text/parse_number.h"

namespace dubsar {
namespace {

constexpr double kFarthestMm = 10'000.0, kMostDeg = 360.0;

}  // namespace

const Option* OptionReader::find(std::string_view name) {
  known_ += (known_.empty() ? "" : ", ") + std::string(name);
  for (auto it = left_.begin(); it != left_.end(); ++it)
    if (it->key == name) {
      found_ = std::move(*it);
      left_.erase(it);
      return &found_;
    }
  return nullptr;
}

void OptionReader::complain(std::string sentence) {
  if (complaint_.empty()) complaint_ = std::move(sentence);
}

std::string OptionReader::first_word() {
  if (left_.empty() || left_.front().value) return {};
  std::string word = std::move(left_.front().key);
  left_.erase(left_.begin());
  return word;
}

bool OptionReader::flag(std::string_view name) {
  const Option* const option = find(name);
  if (option && option->value) complain(fmt::format("{} takes no value", name));
  return option != nullptr;
}

std::string OptionReader::text(std::string_view name, std::string_view fallback) {
  const Option* const option = find(name);
  if (!option) return std::string(fallback);
  if (option->value.value_or("").empty()) complain(fmt::format("{} needs a value", name));
  return option->value.value_or("");
}

double OptionReader::number(std::string_view name, double low, double high, double fallback) {
  const Option* const option = find(name);
  if (!option) return fallback;
  const std::string value = option->value.value_or("");
  const auto parsed = parse_number(value);
  if (parsed && *parsed >= low && *parsed <= high) return *parsed;
  complain(fmt::format("{} is \"{}\", expected a number of {} to {}", name, value, low, high));
  return fallback;
}

int OptionReader::integer(std::string_view name, int low, int high, int fallback) {
  const double value = number(name, low, high, fallback);
  if (value != std::floor(value)) complain(fmt::format("{} is {}, expected a whole number", name, value));
  return static_cast<int>(value);
}

glm::dvec3 OptionReader::triple(std::string_view name, double limit, const glm::dvec3& fallback) {
  const Option* const option = find(name);
  if (!option) return fallback;
  const std::string value = option->value.value_or("");
  const auto parsed = parse_numbers<3>(value, '/');
  if (parsed && std::all_of(parsed->begin(), parsed->end(), [&](double v) { return std::abs(v) <= limit; }))
    return {(*parsed)[0], (*parsed)[1], (*parsed)[2]};
  complain(
      fmt::format("{} is \"{}\", expected three numbers of {} to {} such as 0/-250/250", name, value, -limit, limit));
  return fallback;
}

Pose OptionReader::placement(const Pose& fallback) {
  Pose out = fallback;
  out.position_m = 1e-3 * triple("at", kFarthestMm, 1e3 * fallback.position_m);
  if (std::none_of(left_.begin(), left_.end(), [](const Option& option) { return option.key == "turn"; })) {
    find("turn");  // one of those there are
    return out;
  }
  const glm::dvec3 turn = glm::radians(triple("turn", kMostDeg, glm::dvec3(0.0)));
  out.rotation = glm::angleAxis(turn.y, glm::dvec3(0, 1, 0)) * glm::angleAxis(turn.x, glm::dvec3(1, 0, 0)) *
                 glm::angleAxis(turn.z, glm::dvec3(0, 0, 1));
  return out;
}

std::vector<Option> OptionReader::take_rest() { return std::exchange(left_, {}); }

Result<void> OptionReader::status() const {
  if (!complaint_.empty()) return fail(ErrorKind::kUsage, "{}: {}", whose_, complaint_);
  return {};
}

Result<void> OptionReader::finish() {
  if (!left_.empty()) complain(fmt::format("\"{}\" is not an option, expected one of: {}", left_.front().key, known_));
  return status();
}

}  // namespace dubsar
