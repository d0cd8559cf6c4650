#pragma once
// Numbers and places that commands are told.

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar::app {

/// kUsage unless all of the text is a number of `low` to `high`.
Result<double> number_argument(std::string_view command, const std::string& text, double low, double high);

/// The number of a thing of a list, counted from 1: its place, counted from 0. kUsage unless there is one.
Result<std::size_t> place_argument(std::string_view command, const std::string& text, std::size_t count);

/// "one rest of it": the first word and the rest, without the spaces between.
std::pair<std::string, std::string> first_word(const std::string& text);

/// The first `count` words as places "x,y,z" in mm; what follows them goes to `rest`. kUsage.
Result<std::vector<glm::dvec3>> points_argument(std::string_view command, const std::string& text, std::size_t count,
                                                std::string& rest);

}  // namespace dubsar::app
