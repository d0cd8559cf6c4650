#pragma once
// The files of languages other than English, embedded at build time: name and text of each.

#include <span>
#include <string_view>
#include <utility>

namespace dubsar {

std::span<const std::pair<std::string_view, std::string_view>> language_files();

}  // namespace dubsar
