#pragma once

#include <numbers>

namespace dubsar {

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

}  // namespace dubsar
