#pragma once
// Places and turns in SI units, right-handed.

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace dubsar {

struct Pose {
  glm::dvec3 position_m{0.0, 0.0, 0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< w, x, y, z; unit
  bool operator==(const Pose&) const = default;
};

/// a_from_c = compose(a_from_b, b_from_c)
inline Pose compose(const Pose& outer, const Pose& inner) {
  return {outer.position_m + outer.rotation * inner.position_m, outer.rotation * inner.rotation};
}

inline Pose inverse(const Pose& pose) {
  const glm::dquat back = glm::conjugate(pose.rotation);
  return {back * -pose.position_m, back};
}

inline glm::dvec3 transform(const Pose& pose, const glm::dvec3& point_m) {
  return pose.position_m + pose.rotation * point_m;
}

}  // namespace dubsar
