#include "app/commands/number_argument.h"

#include <algorithm>
#include <charconv>

namespace dubsar::app {

Result<double> number_argument(std::string_view command, const std::string& text, double low, double high) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || !(value >= low && value <= high))
    return fail(ErrorKind::kUsage, "{}: \"{}\" found, expected a number of {} to {}", command, text, low, high);
  return value;
}

Result<std::size_t> place_argument(std::string_view command, const std::string& text, std::size_t count) {
  std::size_t number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end || number < 1 || number > count)
    return fail(ErrorKind::kUsage, "{}: \"{}\" found, expected {}", command, text,
                count == 0 ? "nothing, as there is none" : fmt::format("a number of 1 to {}", count));
  return number - 1;
}

std::pair<std::string, std::string> first_word(const std::string& text) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t space = std::min(text.find(' ', begin), text.size());
  const std::size_t rest = std::min(text.find_first_not_of(' ', space), text.size());
  return {text.substr(begin, space - begin), text.substr(rest)};
}

Result<std::vector<glm::dvec3>> points_argument(std::string_view command, const std::string& text, std::size_t count,
                                                std::string& rest) {
  constexpr double kFarthestMm = 1e11;  // georeferenced places are some 1e9 mm
  std::vector<glm::dvec3> out;
  rest = text;
  for (std::size_t i = 0; i < count; ++i) {
    auto [word, behind] = first_word(rest);
    if (std::count(word.begin(), word.end(), ',') != 2)
      return fail(ErrorKind::kUsage, "{}: \"{}\" found, expected {} place{} such as 12.5,3,40 (mm)", command, text,
                  count, count == 1 ? "" : "s");
    glm::dvec3 point(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t comma = std::min(word.find(','), word.size());
      DUBSAR_ASSIGN(point[axis], number_argument(command, word.substr(0, comma), -kFarthestMm, kFarthestMm));
      word.erase(0, comma + 1);
    }
    out.push_back(point);
    rest = std::move(behind);
  }
  return out;
}

}  // namespace dubsar::app
