#pragma once
// What a hand did.

#include <cstdint>

#include "core/base/system/clock.h"

namespace dubsar {

enum class GestureKind : std::uint8_t { kGrab, kPinch, kSwipe, kDwell };
enum class GesturePhase : std::uint8_t {
  kBegin,
  kEnd,     ///< let go on purpose
  kCancel,  ///< the hand was lost, or a stronger gesture took over
  kDone,    ///< swipe and dwell: it happened
};
enum class SwipeDirection : std::uint8_t { kLeft, kRight, kUp, kDown };

struct GestureEvent {
  TimestampNs time = 0;
  GestureKind kind{};
  GesturePhase phase{};
  SwipeDirection direction{};  ///< of a swipe
};

}  // namespace dubsar
