#pragma once
// Simulated trackers on real sockets, for this program's sources and for others.

#include <functional>
#include <vector>

#include "input/simulated/simulated_feed.h"

namespace dubsar {

struct ServerResult {
  std::int64_t messages = 0;  ///< pieces of bytes sent
  int clients = 0;            ///< of servers
};

/// Lets the person act in real time until it has finished or `over` says so. Drivers of datagrams are sent to `where`
/// (options address, port), streams are served there (address, port: 0 any free one, remote; socket). `ready` is called
/// with the port once clients can come. kUsage: drivers without a socket, no socket path; kUnavailable, kCannotCreate:
/// the address is taken.
Result<ServerResult> serve_simulated(const DriverEntry& driver, const SimulatedFeed& feed,
                                     const std::vector<Option>& where, const Clock& clock,
                                     const std::function<bool()>& over,
                                     const std::function<void(int port)>& ready = {});

}  // namespace dubsar
