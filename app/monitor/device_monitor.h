#pragma once
// Any device that a person can watch: opened by its driver's name, read as JSON.

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/system/clock.h"
#include "devices/device_driver.h"
#include "devices/device_spec.h"

namespace dubsar::app {

class DeviceMonitor {
 public:
  virtual ~DeviceMonitor() = default;
  virtual std::optional<nlohmann::json> poll(TimestampNs now, milliseconds timeout) = 0;
  virtual bool connected() const = 0;
  virtual std::string reason() const = 0;
  virtual std::string note() const = 0;  ///< about an open device: what it was taken for, why nothing comes; else empty
  virtual DriverCounts counts() const = 0;
  virtual TimestampNs newest() const = 0;  ///< when the last sample was measured
};

/// A source of a shared library in place of a driver: "plugin:FILE.so[,...]", as of `--input`.
inline bool is_plugin(std::string_view driver) noexcept { return driver.starts_with("plugin:"); }

/// The driver over any transport, real or replayed; `clock`, that of the times it is polled with, stamps what is read
/// and outlives it. Cameras whose hands are shown need `threaded` where their pictures come in real time. A plug-in has
/// no transport. kUsage: no such driver, options that it does not have.
Result<std::unique_ptr<DeviceMonitor>> monitor_device(const DeviceSpec& spec, OpenTransport open, const Clock& clock,
                                                      bool threaded);

}  // namespace dubsar::app
