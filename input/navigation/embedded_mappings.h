#pragma once
// The mapping files of input/mappings, inside the program.

#include <span>
#include <string_view>
#include <utility>

namespace dubsar {

std::span<const std::pair<std::string_view, std::string_view>> embedded_mappings();

}  // namespace dubsar
