#pragma once
// The panel profiles of display/panels/profiles/, compiled in.

#include <span>
#include <string_view>
#include <utility>

namespace dubsar {

/// (file name, JSON text) of every profile file.
std::span<const std::pair<std::string_view, std::string_view>> embedded_profiles();

}  // namespace dubsar
