#include "devices/reconnector.h"

#include <algorithm>

namespace dubsar {

Transport* Reconnector::transport(TimestampNs now) {
  if (transport_) return transport_.get();
  if (!due_ && now < next_attempt_) return nullptr;
  due_ = false;
  auto opened = open_();
  if (opened) {
    transport_ = std::move(*opened);
    reason_.clear();
    pause_ = kFirstPauseNs;
    ++times_opened_;
    return transport_.get();
  }
  reason_ = std::move(opened).error().message;
  next_attempt_ = now + pause_;
  pause_ = std::min(2 * pause_, kLongestPauseNs);
  return nullptr;
}

void Reconnector::lost(const Error& error, TimestampNs now) {
  transport_.reset();
  reason_ = error.message;
  pause_ = kFirstPauseNs;
  next_attempt_ = now + pause_;
  due_ = false;
}

void Reconnector::wake() noexcept {
  due_ = true;
  pause_ = kFirstPauseNs;
}

}  // namespace dubsar
