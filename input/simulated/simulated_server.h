#pragma once
// Simulated trackers on real sockets, for this program's sources and for others.

#include <functional>

#include "core/base/clock.h"
#include "devices/device_spec.h"
#include "input/simulated/simulated_device.h"

namespace dubsar {

struct LiveWireResult {
  std::int64_t messages = 0;  ///< pieces of bytes sent
  int clients = 0;            ///< of servers
};

/// Lets the person act in real time until it has finished or `over` says so: opentrack sends datagrams to
/// address and port of `choice`, vrpn serves TCP there and calls back who asks by UDP, spacenav serves the UNIX socket
/// of `choice`. `ready` is called with the port once clients can come. kUsage: other drivers, no socket path;
/// kUnavailable, kCannotCreate: the address is taken.
Result<LiveWireResult> serve_live_wire(SimulatedDevice& person, const DeviceSpec& choice, const Clock& clock,
                                       const std::function<bool()>& over,
                                       const std::function<void(int port)>& ready = {});

}  // namespace dubsar
