#pragma once
// Heads before a webcam: who is there, and where both eyes are.

#include <cstdint>
#include <memory>
#include <vector>

#include "devices/frame_source.h"
#include "input/input_source.h"
#include "input/people/person_keeper.h"
#include "input/tracking/face/face_detector.h"
#include "input/tracking/vision/camera_view.h"

namespace dubsar {

struct FaceTrackerOptions {
  CameraView camera;
  double ipd_m = 0.063;        ///< between the pupils; somebody with 58 mm is placed 9 % too far away
  int look_around_frames = 5;  ///< newcomers are looked for in every so manieth frame
  int most_refined = 1;  ///< faces with a second pass in a frame, the kept and then the largest ones: bounds the time
  int most_faces = 6;
};

/// The eyes of a face in the screen frame: depth from the pupils' distance in pixels, corrected for the turn
/// of the head, which the nose's place between them shows. `width`, `height`: of the picture.
struct EyesPlaced {
  glm::dvec3 left_m{0.0}, right_m{0.0};
  double yaw_rad = 0.0;  ///< turn of the head to the person's own left, from facing the camera
};
EyesPlaced place_eyes(const FaceSeen& face, int width, int height, const FaceTrackerOptions& options);

/// One thread.
class FaceTracker {
 public:
  FaceTracker(std::unique_ptr<FaceDetector> detector, const FaceTrackerOptions& options);

  /// RGB frames of one view. `heads` becomes the faces seen in this frame, the largest first, and those of
  /// bystanders seen in the last half second (not tracked, with the time when they were seen); a face keeps
  /// its id that long. Whoever HeadKeeper would keep is looked at in every frame. kBadData: not such a frame.
  /// Cost: one pass of the detector for each followed face (most_refined at most), one more in look-around
  /// frames and when somebody was lost.
  Result<void> track(const Frame& frame, std::vector<HeadFrame>& heads);
  std::string_view detector() const noexcept { return detector_->name(); }

 private:
  struct Person {
    std::uint32_t id = 0;
    FaceSeen face;
    TimestampNs seen = 0;
    bool now = false;   ///< seen in this frame
    bool fine = false;  ///< with a second pass
  };
  void take(const FaceSeen& face, TimestampNs time);

  std::unique_ptr<FaceDetector> detector_;
  FaceTrackerOptions options_;
  std::vector<Person> people_;
  HeadKeeper keeper_;
  std::uint32_t next_id_ = 1, kept_id_ = 0;
  int frames_ = 0;
};

}  // namespace dubsar
