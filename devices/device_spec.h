#pragma once
// Which device is meant, and how devices are reached: the seam at which real ones are replaced by others.

#include <array>
#include <functional>
#include <string>

#include "core/base/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

/// A device by its driver's name, with what that driver has to know to find it. Fields that a driver does not
/// know are ignored.
struct DeviceSpec {
  std::string driver;                 ///< spacemouse, spacenav, opentrack, vrpn, rift, xreal, leap, leapc
  std::string address = "127.0.0.1";  ///< opentrack: to listen on; vrpn: of the server
  int port = 0;                       ///< 0: the protocol's own
  bool allow_remote = false;          ///< opentrack: listen to other machines too
  std::array<bool, 6> invert{};       ///< opentrack: x, y, z, yaw, pitch, roll are turned round
  std::string sender;                 ///< opentrack: "opentrack", "xrlinux"; empty: told by the datagrams' length
  std::string tracker;                ///< vrpn: its name; empty: the first
  int sensor = 0;                     ///< vrpn
  std::string socket;                 ///< spacenav; empty: the usual one
  std::string library;                ///< leapc: the file of Ultraleap's library; empty: where it is usually installed
};

/// Finds out how the chosen device is opened; opens nothing yet. kUsage: no such driver, an impossible
/// choice. The clock outlives all transports and may be read in any thread.
using DeviceOpener = std::function<Result<OpenTransport>(const DeviceSpec& choice, const Clock& clock)>;

/// "x+yaw" and the like. kUsage: says which word is wrong.
Result<std::array<bool, 6>> parse_axes(std::string_view text);

}  // namespace dubsar
