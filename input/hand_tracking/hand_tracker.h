#pragma once
// Hands from stereo infrared pictures, without networks and without the vendor's service: bright region, palm by the
// distance to the outline, fingers by their reach from the palm, depth by correlation of both eyes.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "devices/frame_source.h"
#include "input/hand_frame.h"
#include "input/hand_tracking/hand_picture.h"
#include "input/hand_tracking/stereo_rig.h"

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
/// Measured: palm position, turn of the hand about the vertical, finger tips that stick out, grab. Not measured: the tilt
/// of the palm, joints of bent fingers (valid, not tracked), a pinch whose tips touch. One thread per object.
class HandTracker {
 public:
  explicit HandTracker(const StereoLenses& lenses, const HandTrackerOptions& options = {});

  /// False: the frame cannot be used (wrong size, or a dark one, which is kept and subtracted from the next ones), `hands`
  /// stays. Hands that are not seen are not in `hands`: what to do about a lost hand is decided later.
  bool track(const Frame& frame, Hands& hands);
  /// Forgets identities, handedness and the dark frame.
  void reset();

 private:
  struct Finger {
    glm::dvec2 tip_px{};
    double angle_rad = 0.0;  ///< from the hand's direction, positive to the right in the picture
  };
  struct Silhouette {
    glm::dvec2 palm_px{};
    double radius_px = 0.0;
    glm::dvec2 forward{0.0, 1.0};  ///< unit, picture axes
    double reach = 0.0;            ///< of the fingers, in palm radii
    bool arm_seen = false;
    std::vector<Finger> fingers;
  };
  struct Known {
    std::uint32_t id = 0;
    glm::dvec3 palm_m{};
    TimestampNs time = 0;
    int right_votes = 0;  ///< positive: right hand
  };

  std::optional<Silhouette> outline(const Region& region);
  std::optional<HandFrame> measure(const Silhouette& silhouette, TimestampNs time);
  void place_joints(const Silhouette& silhouette, double depth_m, double radius_m, Known& known, HandFrame& hand) const;
  glm::dvec3 point_m(const glm::dvec2& pixel, double depth_m) const noexcept;
  bool inside(const glm::dvec2& pixel, std::uint8_t label) const noexcept;

  StereoRig rig_;
  HandTrackerOptions options_;
  std::vector<std::uint8_t> dark_, lit_, left_, right_, blurred_, labels_;
  std::vector<std::uint32_t> stack_;
  std::vector<float> distance_;
  std::vector<Known> known_, previous_;
  std::uint32_t next_id_ = 1;
};

}  // namespace dubsar
