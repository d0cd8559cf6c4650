#pragma once
// The parts of a report page that are the same for all, embedded at build time: page.css and viewer.js.

#include <span>
#include <string_view>
#include <utility>

namespace dubsar {

std::span<const std::pair<std::string_view, std::string_view>> page_files();

}  // namespace dubsar
