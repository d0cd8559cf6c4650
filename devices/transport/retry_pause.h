#pragma once
// When to try again to open a device that is not there.

#include <algorithm>

#include "core/base/system/clock.h"

namespace dubsar {

/// Pauses between attempts grow 0.5, 1, 2, 4, 8, 10, 10 ... s; wake() ends the present one. One thread.
class RetryPause {
 public:
  static constexpr TimestampNs kFirstNs = 500'000'000;
  static constexpr TimestampNs kLongestNs = 10'000'000'000;

  bool due(TimestampNs now) const noexcept { return due_ || now >= next_; }
  /// An attempt has failed.
  void failed(TimestampNs now) noexcept {
    due_ = false;
    next_ = now + pause_;
    pause_ = std::min(2 * pause_, kLongestNs);
  }
  void succeeded() noexcept {
    due_ = false;
    pause_ = kFirstNs;
  }
  /// The open device has gone: the next attempt is due after the shortest pause.
  void lost(TimestampNs now) noexcept {
    due_ = false;
    pause_ = kFirstNs;
    next_ = now + pause_;
  }
  /// Try at once, and keep the pauses short again.
  void wake() noexcept {
    due_ = true;
    pause_ = kFirstNs;
  }

 private:
  TimestampNs next_ = 0, pause_ = kFirstNs;
  bool due_ = true;
};

}  // namespace dubsar
