#pragma once
// Keeps a device open: a lost one is opened again, with growing pauses, without ever blocking or sleeping.

#include <memory>
#include <string>

#include "core/base/system/clock.h"
#include "devices/transport/retry_pause.h"
#include "devices/transport/transport.h"

namespace dubsar {

/// Owns one Transport and the state "present or lost". Pauses between attempts are those of RetryPause;
/// wake() ends the present one, for example when a device node has appeared. One thread.
class Reconnector {
 public:
  explicit Reconnector(OpenTransport open) : open_(std::move(open)) {}

  /// The open transport, opening it when an attempt is due; null while the device is lost.
  Transport* transport(TimestampNs now);

  /// Tells that the transport answered kUnavailable: it is closed and the next attempt is due after 0.5 s.
  void lost(const Error& error, TimestampNs now);

  /// Makes the next call of transport() try at once, and the pauses short again.
  void wake() noexcept { retry_.wake(); }

  /// Of now; null while the device is lost.
  const Transport* open_transport() const noexcept { return transport_.get(); }
  bool connected() const noexcept { return transport_ != nullptr; }
  /// Why there is no device now; empty while there is one.
  const std::string& reason() const noexcept { return reason_; }
  /// How often the device has been opened so far.
  int times_opened() const noexcept { return times_opened_; }

 private:
  OpenTransport open_;
  std::unique_ptr<Transport> transport_;
  std::string reason_;
  RetryPause retry_;
  int times_opened_ = 0;
};

}  // namespace dubsar
