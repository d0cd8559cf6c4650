#pragma once
// Infrared stereo pictures of posed hands as a Leap Motion Controller sees them: light from the device that falls with
// the square of the distance, lens distortion, sensor noise.

#include <cstdint>
#include <span>
#include <vector>

#include "devices/leap/hand_model.h"
#include "devices/leap/lmc1_calibration.h"

namespace dubsar {

struct HandRenderOptions {
  int width = 640, height = 240;  ///< of one eye
  double noise_sd = 2.5;          ///< grey levels
  double ambient = 6.0;           ///< grey levels everywhere, also without the device's light
  double reflected = 210.0;       ///< grey level of skin that faces the light at 200 mm
  bool lights_on = true;
  /// Where the lights sit along the device; about so in a Leap Motion Controller. None: one at each eye, so that each
  /// sees the hand shaded in its own way.
  std::vector<double> light_x_m{-0.035, 0.0, 0.035};
};

/// Renders many frames through the same lenses. One thread per object.
class HandRenderer {
 public:
  HandRenderer(const lmc1::Calibration& calibration, const HandRenderOptions& options);

  /// Frame of the device: origin midway between the eyes, x along the device to the right eye, y out of the device, z
  /// to the user. Both pictures are 8-bit, options.width x options.height. The same seed gives the same noise.
  void render(std::span<const PosedHand> hands, std::uint64_t seed, std::span<std::uint8_t> left,
              std::span<std::uint8_t> right) const;
  const HandRenderOptions& options() const noexcept { return options_; }
  void set_lights(bool on) noexcept { options_.lights_on = on; }

 private:
  struct Eye {
    double x_m;
    lmc1::Lens lens;
    std::vector<float> rays;  ///< two per pixel: x/z, y/z
  };
  void render_eye(const Eye& eye, std::span<const PosedHand> hands, std::uint64_t seed,
                  std::span<std::uint8_t> picture) const;

  HandRenderOptions options_;
  Eye left_, right_;
};

/// A plausible calibration: 40 mm baseline, 133.9 px, small offsets, and the radial terms of a real device or none.
lmc1::Calibration example_calibration(bool distorted);

}  // namespace dubsar
