#pragma once

#include "core/base/system/clock.h"

namespace dubsar {

inline constexpr TimestampNs kSecondNs = 1'000'000'000;

}  // namespace dubsar
