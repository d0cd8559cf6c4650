#pragma once
// From the pose of a head in a tracker's frame to both eyes in the screen frame.

#include <optional>

#include "devices/head_tracker/head_sample.h"
#include "input/input_source.h"

namespace dubsar {

struct HeadPlacement {
  Pose screen_from_tracker{};  ///< for trackers without position: `position_m` is where the eyes are when
                               ///< looking ahead
  glm::dvec3 eyes_m{0.0};      ///< midpoint of the eyes seen from the tracked point, head axes
  double ipd_m = 0.063;
};

/// Both eyes. A tracker without position turns the head about a neck 75 mm below and 80.5 mm behind the eyes
/// (the neck model of the Oculus SDK). Nothing for eyes that are not 0.1 to 3 m before the panel,
/// or more than 2.5 m beside, above or below its centre.
std::optional<HeadFrame> head_frame(const HeadSample& sample, const HeadPlacement& placement);

}  // namespace dubsar
