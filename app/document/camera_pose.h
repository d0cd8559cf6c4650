#pragma once
// Where an object is seen from, and where its light stands. Plain values.

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>

namespace dubsar::app {

/// Where the object is seen from: turned from its front view, zoomed, moved (ViewState has the units).
struct CameraPose {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  double zoom = 1.0;
  glm::dvec2 pan{0.0, 0.0};
  double nearer = 0.0;  ///< window heights; where a wearer's hand left the object: of this session only
  friend bool operator==(const CameraPose&, const CameraPose&) = default;
};

struct LightPlace {
  double azimuth_deg = 315.0;   ///< clockwise from the upper side of the picture
  double elevation_deg = 25.0;  ///< above the picture plane
  friend bool operator==(const LightPlace&, const LightPlace&) = default;
};

}  // namespace dubsar::app
