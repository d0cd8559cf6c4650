#pragma once

#include <cstddef>

namespace dubsar {

/// Events kept of one picture's time: a device that floods loses the rest.
inline constexpr std::size_t kMostEvents = 4096;

}  // namespace dubsar
