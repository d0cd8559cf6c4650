#pragma once

#include "core/base/clock.h"

namespace dubsar {

inline constexpr TimestampNs kSecondNs = 1'000'000'000;

}  // namespace dubsar
