#include "devices/transport/reconnector.h"

namespace dubsar {

Transport* Reconnector::transport(TimestampNs now) {
  if (transport_) return transport_.get();
  if (!retry_.due(now)) return nullptr;
  auto opened = open_();
  if (opened) {
    transport_ = std::move(*opened);
    reason_.clear();
    retry_.succeeded();
    ++times_opened_;
    return transport_.get();
  }
  reason_ = std::move(opened).error().message;
  retry_.failed(now);
  return nullptr;
}

void Reconnector::lost(const Error& error, TimestampNs now) {
  transport_.reset();
  reason_ = error.message;
  retry_.lost(now);
}

}  // namespace dubsar
