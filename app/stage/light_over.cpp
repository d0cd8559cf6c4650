#include "app/stage/light_over.h"

#include <algorithm>
#include <cmath>

#include "core/base/numbers/angle.h"
#include "display/render/shading.h"

namespace dubsar::app {

LightPlace light_over(double x, double y) noexcept {
  const double azimuth = std::fmod(std::atan2(x, y) / kRadPerDeg + 360.0, 360.0);
  return {azimuth,
          std::clamp(std::acos(std::min(1.0, std::hypot(x, y))) / kRadPerDeg, kLowestLightDeg, kHighestLightDeg)};
}

glm::dvec3 place_over(const LightPlace& light) {
  Light same;
  same.azimuth_deg = light.azimuth_deg;
  same.elevation_deg = light.elevation_deg;
  return light_direction(same);
}

}  // namespace dubsar::app
