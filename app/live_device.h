#pragma once
// Any device that a person can watch: opened by its driver's name, read as JSON.

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/clock.h"
#include "devices/driver.h"

namespace dubsar::app {

struct DeviceChoice {
  std::string driver;                      ///< spacemouse, spacenav, opentrack, vrpn, rift, xreal
  std::string address = "127.0.0.1";       ///< opentrack: to listen on; vrpn: of the server
  int port = 0;                            ///< 0: the protocol's own
  bool allow_remote = false;               ///< opentrack: listen to other machines too
  std::string tracker;                     ///< vrpn
  std::string socket;                      ///< spacenav; empty: the usual one
};

class LiveDevice {
 public:
  virtual ~LiveDevice() = default;
  virtual std::optional<nlohmann::json> poll(TimestampNs now, milliseconds timeout) = 0;
  virtual bool connected() const = 0;
  virtual const std::string& reason() const = 0;
  virtual const DriverCounts& counts() const = 0;
};

/// How the real device is reached. kUsage: no such driver. `clock` outlives it.
Result<OpenTransport> device_opener(const DeviceChoice& choice, const Clock& clock);

/// The driver over any transport, real or replayed. kUsage: no such driver.
Result<std::unique_ptr<LiveDevice>> make_live_device(const DeviceChoice& choice, OpenTransport open);

}  // namespace dubsar::app
