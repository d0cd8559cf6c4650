#pragma once
// The Leap Motion Controller as a kind of stereo camera, over any transport that carries USB requests.

#include <cstdint>
#include <memory>

#include "core/base/system/clock.h"
#include "devices/leap/lmc1_calibration.h"
#include "devices/leap/lmc1_protocol.h"
#include "devices/leap/stereo_camera.h"
#include "devices/transport/transport.h"

namespace dubsar {

struct Lmc1Options {
  int width = 640, height = 240;
  int exposure_us = 200;
  int analog_gain_sixteenths = 16;
  int dark_frame_interval = 0;  ///< n: every n-th frame is taken without light; 0: none
  bool leds = true;
  /// Between the address and the byte of the calibration read-out (156 times): the device needs about 4 ms.
  milliseconds calibration_settle{4};
};

/// For make_stereo_camera(), whose start() reads the calibration (0.7 s on a device), commits the mode and lights the
/// LEDs. Every 640x240 pair is one Frame with two views.
std::unique_ptr<StereoCameraKind> lmc1_kind(const Lmc1Options& options);

/// Calibration by the sharpness and saturation knock. `settle` as in Lmc1Options.
Result<lmc1::Calibration> read_lmc1_calibration(Transport& transport, milliseconds settle);

}  // namespace dubsar
