#pragma once

namespace dubsar {

inline constexpr double kMmPerInch = 25.4;

}  // namespace dubsar
