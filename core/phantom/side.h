#pragma once
// The six sides of a tablet and how they are turned while writing. Model space: x to the right along the lines of the
// obverse, y from obverse to reverse, z up; the scribe turns the tablet about the x axis.

#include <array>
#include <cstdint>

namespace dubsar::phantom {

enum class Side : std::uint8_t { kObverse, kReverse, kLower, kUpper, kLeft, kRight };
inline constexpr int kSides = 6;

/// Axis of model space with a sign.
struct SignedAxis {
  int axis;
  float sign;
};

/// Outward normal, reading direction and up; right x up = normal.
struct SideFrame {
  SignedAxis normal, right, up;
};

inline constexpr std::array<SideFrame, kSides> kSideFrames{{
    {{1, -1}, {0, 1}, {2, 1}},    // obverse
    {{1, 1}, {0, 1}, {2, -1}},    // reverse: upside down
    {{2, -1}, {0, 1}, {1, -1}},   // lower edge, between obverse and reverse
    {{2, 1}, {0, 1}, {1, 1}},     // upper edge
    {{0, -1}, {2, -1}, {1, -1}},  // left edge, written along its length
    {{0, 1}, {1, 1}, {2, 1}},     // right edge: the lines of the obverse run on
}};

}  // namespace dubsar::phantom
