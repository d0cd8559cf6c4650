#pragma once
// Hands from stereo infrared pictures, without networks and without the vendor's service: bright region, palm by the
// distance to the outline, depth by correlation of both eyes; then a hand of cones is fitted to both silhouettes.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "devices/frame_source.h"
#include "input/hand_frame.h"
#include "input/tracking/hands/eye_samples.h"
#include "input/tracking/hands/hand_picture.h"
#include "input/tracking/hands/hand_search.h"
#include "input/tracking/hands/known_hands.h"
#include "input/tracking/hands/silhouette.h"
#include "input/tracking/hands/stereo_rig.h"

namespace dubsar {

struct HandTrackerOptions {
  int most_hands = 2;
  double nearest_m = 0.08, farthest_m = 0.6;
  double skin_fraction = 0.15;  ///< of the way from background to bright skin
  int skin_margin = 6;          ///< grey levels above the background at least
};

/// Sees hands that are held over the device, palm down, the arm coming from the user's side (+Z). Frame of the result:
/// origin midway between the eyes, x along the device, y out of it, z to the user; metres.
///
/// No filter, no latency beyond the frame: what is carried on is identity, left or right, size and where the fit
/// starts. Measured: palm position and rotation, joints of fingers that are in view, grab (mean bend of the four
/// fingers). Not measured: joints of bent fingers (valid, not tracked). Where no hand fits the pictures, palm and grab
/// come from the outline alone and the confidence is at most 0.3. One thread per object.
class HandTracker {
 public:
  explicit HandTracker(const StereoLenses& lenses, const HandTrackerOptions& options = {});

  /// False: the frame cannot be used (wrong size, or a dark one, which is kept and subtracted from the next ones),
  /// `hands` stays. Hands that are not seen are not in `hands`: what to do about a lost hand is decided later.
  bool track(const Frame& frame, Hands& hands);
  /// Forgets identities, handedness and the dark frame.
  void reset();

 private:
  struct Pictures {  ///< of the frame in work; kept so that no frame needs memory of its own
    std::vector<std::uint8_t> dark, lit, left, right, blurred, labels;
    std::vector<std::uint32_t> stack;
    std::vector<float> distance;
  };

  std::optional<HandGuess> guess(const Silhouette& silhouette, double& confidence) const;
  void sample(int eye, const Region& region, const Silhouette& silhouette, double depth_m, int background,
              EyeSamples& samples) const;
  HandFrame measure(const Region& region, const Silhouette& silhouette, const HandGuess& guess, int background,
                    TimestampNs time);
  std::span<const std::uint8_t> eye_pixels(int eye) const noexcept {
    return pixels_.subspan(static_cast<std::size_t>(eye) * rig_.device_pixels(), rig_.device_pixels());
  }

  StereoRig rig_;
  HandTrackerOptions options_;
  std::array<std::array<EyeRays, 2>, 2> rays_;  ///< [every column, every second][eye]
  HandFit fit_;
  std::array<EyeSamples, 2> samples_;
  std::span<const std::uint8_t> pixels_;  ///< both eyes of the frame in work
  Pictures pictures_;
  KnownHands known_;
};

}  // namespace dubsar
