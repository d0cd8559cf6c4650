#pragma once
// Tells the service manager that the kiosk lives: the datagrams of sd_notify(3).

#include <string>
#include <string_view>

#include "core/base/system/clock.h"

namespace dubsar::app {

/// One thread: that of the session's loop, which draws, so that a loop that hangs is noticed. Without a manager it does
/// nothing.
class ServiceNotify {
 public:
  /// `socket` as in NOTIFY_SOCKET ("@" first: an abstract one), `watchdog_us` as in WATCHDOG_USEC; empty and 0: none.
  explicit ServiceNotify(std::string_view socket = {}, std::int64_t watchdog_us = 0);
  ~ServiceNotify();
  ServiceNotify(const ServiceNotify&) = delete;
  ServiceNotify& operator=(const ServiceNotify&) = delete;

  /// The first picture was shown.
  void ready() { send("READY=1"); }
  /// The loop turned while its window was on the screen; said at most as often as a third of the watchdog's time.
  void alive(TimestampNs now);
  void status(std::string_view words);
  void stopping() { send("STOPPING=1"); }

 private:
  void send(std::string_view text);
  int descriptor_ = -1;
  std::string address_;
  TimestampNs every_ = 0, said_ = -1;
};

}  // namespace dubsar::app
