#pragma once
// Any device that a person can watch: opened by its driver's name, read as JSON.

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/clock.h"
#include "devices/device_choice.h"
#include "devices/driver.h"

namespace dubsar::app {

class LiveDevice {
 public:
  virtual ~LiveDevice() = default;
  virtual std::optional<nlohmann::json> poll(TimestampNs now, milliseconds timeout) = 0;
  virtual bool connected() const = 0;
  virtual const std::string& reason() const = 0;
  virtual const DriverCounts& counts() const = 0;
};

/// The driver over any transport, real or replayed. kUsage: no such driver.
Result<std::unique_ptr<LiveDevice>> make_live_device(const DeviceChoice& choice, OpenTransport open);

}  // namespace dubsar::app
