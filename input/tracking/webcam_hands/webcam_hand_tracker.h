#pragma once
// Hands before a webcam as the joints that gestures read.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "devices/frame_source.h"
#include "input/hand_frame.h"
#include "input/people/one_euro.h"
#include "input/tracking/vision/camera_view.h"
#include "input/tracking/webcam_hands/hand_networks.h"

namespace dubsar {

struct WebcamHandOptions {
  CameraView camera;
  double hand_size = 1.0;  ///< of the usual one: a hand 10 % larger than it is taken for is placed 10 % too near
  int most_hands = 2;
  int look_around_frames = 15;  ///< with one hand followed, another one is looked for in every so manieth frame
  OneEuroOptions place_filter{2.0, 20.0, 2.0};
};

/// Where the hand's middle is for its landmarks to appear where they do (least squares over all of them);
/// camera frame of CameraView. Nothing for shapes without extent and places nearer than 5 cm or farther than
/// 3 m.
std::optional<glm::dvec3> place_hand(const HandSeen& hand, int width, int height, const CameraView& camera,
                                     double hand_size);

/// All 26 joints in the screen frame from landmarks in the screen frame (metres, order of kLandmarks). The
/// joints inside the palm, which have no landmark, are valid and not tracked. Also palm, grab strength and
/// pinch distance.
HandFrame hand_from_landmarks(const std::array<glm::dvec3, kLandmarks>& landmarks_m, Chirality chirality);

/// One thread.
class WebcamHandTracker {
 public:
  WebcamHandTracker(std::unique_ptr<HandNetworks> networks, const WebcamHandOptions& options);

  /// RGB frames of one view. `hands` becomes all hands seen in this frame, screen frame. Cost: 10 ms for each
  /// followed hand; 30 ms more when none is followed and in look-around frames. kBadData: not such a frame.
  Result<void> track(const Frame& frame, Hands& hands);

 private:
  struct Known {
    std::uint32_t id = 0;
    SquareCrop crop;
    double right_votes = 0.0;
    OneEuroVector place;
    TimestampNs time = 0;
    std::optional<glm::dvec3> palm_m{};  ///< when last seen
  };
  Result<std::optional<HandFrame>> look(const Frame& frame, Known& known);

  std::unique_ptr<HandNetworks> networks_;
  WebcamHandOptions options_;
  std::vector<Known> known_;
  std::uint32_t next_id_ = 1;
  int frames_ = 0;
};

}  // namespace dubsar
