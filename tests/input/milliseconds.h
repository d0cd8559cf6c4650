#pragma once
#include "core/base/system/clock.h"

namespace dubsar::test {

inline constexpr TimestampNs kMs = 1'000'000;

}  // namespace dubsar::test
