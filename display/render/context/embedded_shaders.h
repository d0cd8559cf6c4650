#pragma once
// The GLSL files of shaders/, compiled in.

#include <span>
#include <string_view>
#include <utility>

namespace dubsar {

/// (file name, text) of every shader.
std::span<const std::pair<std::string_view, std::string_view>> embedded_shaders();

}  // namespace dubsar
