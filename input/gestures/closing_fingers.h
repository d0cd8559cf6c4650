#pragma once
// Whether the fingers of a hand are closing just now.

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/system/clock.h"

namespace dubsar {

/// A closing hand drags its palm along: of real ones before a tracker (two closings, leapjs-playback) by 18 and 33 mm
/// at up to .24 m/s, within .36 s. What moves so is at rest all the same.
class ClosingFingers {
 public:
  static constexpr double kPalmM = 0.045;   ///< the palm's way: the longest of a movement of the fingers there
  static constexpr double kPalmMps = 0.36;  ///< its speed: half as much again, for swift people

  /// `grab` 0..1, `pinch_m`: thumb to index finger; either tells, the thumb first.
  void update(TimestampNs now, double grab, double pinch_m) {
    constexpr double kOpenPinchM = 0.1, kClosing = 0.2;  // of 2; noise is .03
    constexpr TimestampNs kWindowNs = 150'000'000, kStepNs = 15'000'000;
    const double closed = grab + std::clamp(1.0 - pinch_m / kOpenPinchM, 0.0, 1.0);
    double least = closed;
    for (std::size_t i = 0; i < count_; ++i)
      if (now - lately_[i].time <= kWindowNs) least = std::min(least, lately_[i].closed);
    if (closed - least > kClosing) closing_ = now;
    if (count_ == 0 || now - newest_ >= kStepNs) {
      lately_[next_] = {now, closed};
      next_ = (next_ + 1) % lately_.size();
      count_ = std::min(count_ + 1, lately_.size());
      newest_ = now;
    }
  }
  void lose() { *this = {}; }
  /// They close, or did a moment ago.
  bool closing(TimestampNs now) const noexcept {
    constexpr TimestampNs kAfterNs = 200'000'000;  // until the palm has come to rest, too
    return closing_ >= 0 && now - closing_ <= kAfterNs;
  }

 private:
  struct Moment {
    TimestampNs time = 0;
    double closed = 0.0;
  };
  std::array<Moment, 12> lately_{};
  std::size_t next_ = 0, count_ = 0;
  TimestampNs newest_ = 0, closing_ = -1;
};

}  // namespace dubsar
