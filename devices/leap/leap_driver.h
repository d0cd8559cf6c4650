#pragma once
// A Leap camera as a driver: opened again when it was lost, its newest pictures with the calibration that they need.

#include <memory>

#include "core/base/text/option_reader.h"
#include "devices/device_driver.h"
#include "devices/leap/leap_camera.h"

namespace dubsar {

/// Blocks on the wire that the kernel fills while hands are looked for: 6 frames of 640x240, 50 ms.
inline constexpr int kStereoTransfersInFlight = 120;

/// Options: exposure_us. Reads in the thread that asks, without one of its own.
std::unique_ptr<DeviceDriver> drive_leap(OpenTransport open, OptionReader& options, const Clock* stamps);

std::unique_ptr<DeviceDriver> make_leap_driver(OpenTransport open, const LeapCameraOptions& options,
                                               const Clock& clock);

}  // namespace dubsar
