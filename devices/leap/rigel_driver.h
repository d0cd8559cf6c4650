#pragma once
// Rigel and Stereo IR 170 as a kind of stereo camera, over any transport that carries USB requests.

#include <memory>

#include "devices/leap/rigel_protocol.h"
#include "devices/leap/stereo_camera.h"

namespace dubsar {

struct RigelOptions {
  int width = 640, height = 480;  ///< of one eye; one of the sizes that the device's descriptors list
  int exposure_us = 200;
  int gain_step = 0;            ///< 0 to 64
  int dark_frame_interval = 0;  ///< 0 none, 1 all, 2, 4 to 128: every n-th frame is taken without light
  bool leds = true;
};

/// For make_stereo_camera(), whose start() reads the descriptors and the calibration, commits the mode and lights the
/// LEDs. kUnavailable: the pictures come isochronously. kBadData: another camera, or no such size (lists those there
/// are). The last line of a picture, where the device writes numbers, is a copy of the one above.
std::unique_ptr<StereoCameraKind> rigel_kind(const RigelOptions& options);

}  // namespace dubsar
