#include "devices/head_tracker/imu_fusion.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

constexpr double kLevelTime_s = 2.0;
constexpr double kMeanTime_s = 0.3, kStillTime_s = 1.0, kBiasTime_s = 1.0;
constexpr double kStill_rad_s = 0.01, kMostBias_rad_s = 0.035, kStillForce = 0.05;

/// `share` of the smallest turn that takes the unit vector `from` to the unit vector `to`.
glm::dquat turn_towards(const glm::dvec3& from, const glm::dvec3& to, double share) {
  const glm::dvec3 axis = glm::cross(from, to);
  const double sine = glm::length(axis);
  const double angle = std::atan2(sine, glm::dot(from, to));
  if (sine < 1e-9) return {1.0, 0.0, 0.0, 0.0};
  return glm::angleAxis(share * angle, axis / sine);
}

}  // namespace

void ImuFusion::update(const ImuSample& sample, double dt_s) noexcept {
  dt_s = std::clamp(dt_s, 0.0, 0.1);
  learn_bias(sample, dt_s);
  const glm::dvec3 turn_rad_s = sample.turn_rate_rad_s - bias_rad_s_;
  const double rate = glm::length(turn_rad_s);
  if (rate * dt_s > 1e-12) world_from_head_ = world_from_head_ * glm::angleAxis(rate * dt_s, turn_rad_s / rate);
  const double force = glm::length(sample.acceleration_m_s2);
  if (std::abs(force - kStandardGravity) < 0.1 * kStandardGravity) {
    const glm::dvec3 up = world_from_head_ * (sample.acceleration_m_s2 / force);
    const double share = levelled_ ? 1.0 - std::exp(-dt_s / kLevelTime_s) : 1.0;
    world_from_head_ = turn_towards(up, {0.0, 1.0, 0.0}, share) * world_from_head_;
    levelled_ = true;
  }
  world_from_head_ = glm::normalize(world_from_head_);
}

void ImuFusion::learn_bias(const ImuSample& sample, double dt_s) noexcept {
  const double share = 1.0 - std::exp(-dt_s / kMeanTime_s);
  const glm::dvec3 off = sample.turn_rate_rad_s - mean_rad_s_;
  mean_rad_s_ += share * off;
  variance_ += share * (glm::dot(off, off) - variance_);
  const double force = glm::length(sample.acceleration_m_s2);
  const bool still = variance_ < kStill_rad_s * kStill_rad_s && glm::length(mean_rad_s_) < kMostBias_rad_s &&
                     std::abs(force - kStandardGravity) < kStillForce * kStandardGravity;
  still_s_ = still ? still_s_ + dt_s : 0.0;
  if (still_s_ >= kStillTime_s) bias_rad_s_ += (1.0 - std::exp(-dt_s / kBiasTime_s)) * (mean_rad_s_ - bias_rad_s_);
}

void ImuFusion::recentre() noexcept {
  const glm::dvec3 back = world_from_head_ * glm::dvec3(0.0, 0.0, 1.0);
  recentred_ = glm::angleAxis(-std::atan2(back.x, back.z), glm::dvec3(0.0, 1.0, 0.0));
}

}  // namespace dubsar
