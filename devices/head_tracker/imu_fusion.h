#pragma once
// Orientation from a gyroscope, held level by an accelerometer.

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace dubsar {

inline constexpr double kStandardGravity = 9.81;  // m/s2

/// One reading, in the head's axes: x right, y up, z backwards.
struct ImuSample {
  glm::dvec3 acceleration_m_s2{0.0};  ///< specific force: +9.81 along y when level and at rest
  glm::dvec3 turn_rate_rad_s{0.0};
};

/// Integrates the turn rate exactly over each step and turns the result towards gravity with time constant 2 s while
/// the force is within 10 % of 9.81 m/s^2 (complementary filter, after Mahony et al. 2008). The gyroscope's bias is
/// learnt while the head is at rest: turn rate steady within 0.01 rad/s for 1 s and below 0.035 rad/s (2 degrees/s).
/// The heading still drifts, as nothing measures it; recentre() makes the present one zero.
class ImuFusion {
 public:
  void update(const ImuSample& sample, double dt_s) noexcept;
  /// Turns head axes to world axes; unit.
  glm::dquat world_from_head() const noexcept { return recentred_ * world_from_head_; }
  void recentre() noexcept;
  /// Forgets everything but the bias.
  void reset() noexcept {
    const glm::dvec3 bias = bias_rad_s_;
    *this = {};
    bias_rad_s_ = bias;
  }

 private:
  void learn_bias(const ImuSample& sample, double dt_s) noexcept;
  glm::dvec3 bias_rad_s_{0.0}, mean_rad_s_{0.0};
  double variance_ = 0.0, still_s_ = 0.0;
  glm::dquat world_from_head_{1.0, 0.0, 0.0, 0.0};
  glm::dquat recentred_{1.0, 0.0, 0.0, 0.0};  ///< a turn about the vertical
  bool levelled_ = false;                     ///< the first reading sets the level at once
};

}  // namespace dubsar
