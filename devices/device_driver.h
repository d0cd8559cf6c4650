#pragma once
// A device that is read, whatever its bytes look like: what drivers have in common for those who do not care which.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "core/base/system/clock.h"
#include "devices/head_tracker/head_sample.h"
#include "devices/spacemouse/spacemouse_sample.h"
#include "devices/touch/touch_sample.h"
#include "devices/transport/transport.h"

namespace dubsar {

struct Frame;
namespace lmc1 {
struct Calibration;
}

/// Two infrared pictures of one moment. Both are the driver's, and good until it is asked again.
struct StereoSample {
  TimestampNs time = 0;
  const Frame* picture = nullptr;
  const lmc1::Calibration* calibration = nullptr;
};

using DeviceSample = std::variant<SpaceMouseSample, HeadSample, StereoSample, TouchSample>;

inline TimestampNs time_of(const DeviceSample& sample) {
  return std::visit([](const auto& s) { return s.time; }, sample);
}

struct DriverCounts {
  std::uint64_t accepted = 0, refused = 0, losses = 0;
};

/// One thread.
class DeviceDriver {
 public:
  virtual ~DeviceDriver() = default;
  /// The newest sample since the last call; waits at most `timeout` for one. A lost device is a state: this gives
  /// nothing then, and tries to open it again.
  virtual std::optional<DeviceSample> next(TimestampNs now, milliseconds timeout) = 0;
  virtual bool connected() const noexcept = 0;
  virtual const std::string& reason() const noexcept = 0;  ///< why it is not connected
  /// One sentence about an open device: what it was taken for, or why nothing comes of it; else empty.
  virtual std::string note() const = 0;
  virtual const DriverCounts& counts() const noexcept = 0;
  virtual void wake() noexcept = 0;      ///< a device node has appeared: try to open it at once
  virtual void recentre() noexcept = 0;  ///< the present heading is "straight on", for devices whose heading drifts
};

}  // namespace dubsar
