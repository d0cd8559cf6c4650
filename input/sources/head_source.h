#pragma once
// Head trackers as a source: from the pose of a head in a tracker's frame to both eyes in the screen frame.

#include "devices/head_tracker/head_sample.h"
#include "input/input_source.h"

namespace dubsar {

struct HeadPlacement {
  Pose screen_from_tracker{};  ///< for trackers without position: `position_m` is where the eyes are when
                               ///< looking ahead
  glm::dvec3 eyes_m{0.0};      ///< midpoint of the eyes seen from the tracked point, head axes
  double ipd_m = 0.063;
};

/// Where a tracker stands unless told: opentrack's own poses count from where the viewer sits, 600 mm before
/// the panel; VRPN servers give the screen frame.
glm::dvec3 usual_place_m(std::string_view tracker) noexcept;

/// Both eyes. A tracker without position turns the head about a neck 75 mm below and 80.5 mm behind the eyes
/// (the neck model of the Oculus SDK). Nothing for eyes that are not 0.1 to 3 m before the panel,
/// or more than 2.5 m beside, above or below its centre.
std::optional<HeadFrame> head_frame(const HeadSample& sample, const HeadPlacement& placement);

/// Options: the tracker's name first (opentrack, vrpn, rift, xreal), then at, turn, eyes, ipd, replay, speed, simulate,
/// seed; opentrack: port, address, remote, invert=x+yaw, sender=xrlinux; vrpn: port, address, tracker, sensor.
Result<std::unique_ptr<InputSource>> make_head_source(const InputConfig& config);

}  // namespace dubsar
