#pragma once

#include <cstddef>

namespace dubsar {

/// Events kept of one picture's time: a device that floods loses the rest.
inline constexpr std::size_t kMostEvents = 4096;

/// Moments of a touch panel, of the same.
inline constexpr std::size_t kMostTouchFrames = 1024;

}  // namespace dubsar
