#pragma once
// One-Euro filter (Casiez, Roussel, Vogel 2012): a low-pass whose cut-off rises with speed, so that a resting hand does
// not tremble and a moving one does not lag.

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>

#include "core/base/system/clock.h"

namespace dubsar {

struct OneEuroOptions {
  double min_cutoff_hz = 1.0;         ///< at rest
  double beta = 0.5;                  ///< Hz per unit of speed
  double derivative_cutoff_hz = 1.0;  ///< of the speed estimate
};

/// alpha of an exponential filter with this cut-off for a step of dt seconds.
inline double low_pass_alpha(double cutoff_hz, double dt_s) noexcept {
  const double tau = 1.0 / (2.0 * std::numbers::pi * cutoff_hz);
  return 1.0 / (1.0 + tau / dt_s);
}

/// For vectors: the cut-off follows the norm of the velocity. Samples with a time stamp not after the last one are
/// ignored (the last output is returned again); after a gap of more than `reset_after_s` the filter starts anew.
class OneEuroVector {
 public:
  explicit OneEuroVector(const OneEuroOptions& options = {}, double reset_after_s = 0.5)
      : options_(options), reset_after_s_(reset_after_s) {}

  glm::dvec3 filter(TimestampNs time, const glm::dvec3& sample) noexcept {
    if (!last_time_) return start(time, sample);
    const double dt = 1e-9 * static_cast<double>(time - *last_time_);
    if (dt <= 0.0) return value_;
    if (dt > reset_after_s_) return start(time, sample);
    const glm::dvec3 raw_velocity = (sample - last_sample_) / dt;
    velocity_ = glm::mix(velocity_, raw_velocity, low_pass_alpha(options_.derivative_cutoff_hz, dt));
    const double cutoff = options_.min_cutoff_hz + options_.beta * glm::length(velocity_);
    value_ = glm::mix(value_, sample, low_pass_alpha(cutoff, dt));
    last_time_ = time;
    last_sample_ = sample;
    return value_;
  }
  const glm::dvec3& velocity() const noexcept { return velocity_; }  ///< units per second, smoothed
  void reset() noexcept { last_time_.reset(); }

 private:
  glm::dvec3 start(TimestampNs time, const glm::dvec3& sample) noexcept {
    last_time_ = time;
    last_sample_ = value_ = sample;
    velocity_ = glm::dvec3(0.0);
    return value_;
  }
  OneEuroOptions options_;
  double reset_after_s_;
  std::optional<TimestampNs> last_time_;
  glm::dvec3 last_sample_{0.0}, value_{0.0}, velocity_{0.0};
};

/// For rotations: the speed is the angular speed in rad/s, mixing is slerp.
class OneEuroRotation {
 public:
  explicit OneEuroRotation(const OneEuroOptions& options = {}, double reset_after_s = 0.5)
      : options_(options), reset_after_s_(reset_after_s) {}

  glm::dquat filter(TimestampNs time, glm::dquat sample) noexcept {
    const double dt = last_time_ ? 1e-9 * static_cast<double>(time - *last_time_) : 0.0;
    if (last_time_ && dt <= 0.0) return value_;
    if (!last_time_ || dt > reset_after_s_) {
      speed_ = 0.0;
      value_ = last_sample_ = sample;
    } else {
      if (glm::dot(sample, last_sample_) < 0.0) sample = -sample;  // the same rotation, the near way
      const double cosine = std::min(1.0, std::abs(glm::dot(sample, last_sample_)));
      const double raw_speed = 2.0 * std::acos(cosine) / dt;
      speed_ += low_pass_alpha(options_.derivative_cutoff_hz, dt) * (raw_speed - speed_);
      const double cutoff = options_.min_cutoff_hz + options_.beta * speed_;
      value_ = glm::normalize(glm::slerp(value_, sample, low_pass_alpha(cutoff, dt)));
      last_sample_ = sample;
    }
    last_time_ = time;
    return value_;
  }
  void reset() noexcept { last_time_.reset(); }

 private:
  OneEuroOptions options_;
  double reset_after_s_;
  std::optional<TimestampNs> last_time_;
  glm::dquat last_sample_{1.0, 0.0, 0.0, 0.0}, value_{1.0, 0.0, 0.0, 0.0};
  double speed_ = 0.0;
};

}  // namespace dubsar
