#pragma once
// What every touch panel gives: the fingers on its glass, moment by moment.

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "core/base/system/clock.h"

namespace dubsar {

/// More fingers at once are a palm or a sleeve, and none of them counts.
inline constexpr std::size_t kMostTouches = 5;

/// One finger on the glass.
struct TouchContact {
  std::uint32_t id = 0;  ///< the same as long as it stays on the glass, of another finger never
  glm::dvec2 at{0.0};    ///< shares of the panel's width and height from its upper left corner, 0..1
  bool operator==(const TouchContact&) const = default;
};

/// All fingers at one moment.
struct TouchFrame {
  TimestampNs time = 0;
  std::vector<TouchContact> contacts{};  ///< at most kMostTouches, in the order in which they came
  /// Fingers that are missing since the last frame were not lifted: they turned out to be a palm, or nobody knows what
  /// became of them.
  bool cancelled = false;
  bool operator==(const TouchFrame&) const = default;
};

/// All that happened since the last sample, oldest first, never empty.
struct TouchSample {
  TimestampNs time = 0;  ///< of the last frame
  std::vector<TouchFrame> frames{};
};

/// Adds a frame to those that nobody has taken yet, of which at most `most` are kept: the oldest goes, and what was
/// cancelled in it is so in the next.
inline void add_touch_frame(std::vector<TouchFrame>& frames, TouchFrame frame, std::size_t most) {
  frames.push_back(std::move(frame));
  if (frames.size() <= most) return;
  frames[1].cancelled = frames[1].cancelled || frames[0].cancelled;
  frames.erase(frames.begin());
}

}  // namespace dubsar
