#pragma once
// The Leap Motion Controller as a source of stereo pictures, over any transport that carries USB requests.

#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/clock.h"
#include "devices/frame_source.h"
#include "devices/leap/lmc1_calibration.h"
#include "devices/leap/lmc1_protocol.h"
#include "devices/transport.h"

namespace dubsar {

struct Lmc1Options {
  int width = 640, height = 240;
  int exposure_us = 200;
  int analog_gain_sixteenths = 16;
  int dark_frame_interval = 0;  ///< n: every n-th frame is taken without light; 0: none
  bool leds = true;
  bool own_thread = true;       ///< false: poll() reads what has come (for clocks that are moved by hand)
  /// Between the address and the byte of the calibration read-out (156 times): the device needs about 4 ms.
  milliseconds calibration_settle{4};
};

struct Lmc1Counters {
  std::uint64_t frames = 0, dropped_frames = 0, bad_transfers = 0;
};

class Lmc1Driver : public FrameSource {
 public:
  /// From the device, in start(); nothing before.
  virtual std::optional<lmc1::Calibration> calibration() const = 0;
  /// Applied by the reader thread before its next read; the source must be running.
  virtual Result<void> set_exposure(int us) = 0;
  virtual Result<void> set_dark_frame_interval(int n) = 0;
  virtual Lmc1Counters counters() const = 0;
};

/// start() opens, reads the calibration (0.7 s on a device), commits the mode, lights the LEDs and starts one reader
/// thread. Every 640x240 pair is one Frame with two views; `time` is that of the clock at the last byte. The clock must
/// outlive the driver and be safe for use from the reader thread.
std::unique_ptr<Lmc1Driver> make_lmc1_driver(OpenTransport open, const Lmc1Options& options, const Clock& clock);

/// Calibration by the sharpness and saturation knock. `settle` as in Lmc1Options.
Result<lmc1::Calibration> read_lmc1_calibration(Transport& transport, milliseconds settle);

}  // namespace dubsar
