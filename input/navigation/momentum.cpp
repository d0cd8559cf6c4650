#include "input/navigation/momentum.h"

#include <algorithm>
#include <cmath>

#include "core/base/numbers/angle.h"

namespace dubsar {
namespace {

constexpr double kThrowDegPerS = 12.0;  // slower releases do not glide on
constexpr double kRestDegPerS = 1.0;
constexpr double kLongestStepS = 1.0 / 60.0;           // a late frame may not make up for its lateness in one jump
constexpr double kMostPendingRad = 20.0 * kRadPerDeg;  // a hand that is faster than the object slips on it
constexpr double kMostPendingZoom = 0.4;

}  // namespace

void turn_view(ViewState& view, const glm::dvec3& vector_rad) {
  if (vector_rad == glm::dvec3(0.0)) return;
  view.rotation = glm::normalize(turn_of(vector_rad) * view.rotation);
}

void Momentum::throw_by(const glm::dvec3& velocity_mps, const HandMapping& hands) {
  const glm::dvec3 v = velocity_mps * 1e3 * hands.turn_deg_per_mm;
  const double speed = std::hypot(v.x, v.y);
  if (speed > kThrowDegPerS && hands.inertia_s > 0)
    inertia_rad_per_s_ = kRadPerDeg * std::min(1.0, hands.fastest_turn_deg_per_s / speed) * glm::dvec3(-v.y, v.x, 0);
}

void Momentum::drop() {
  turn_rad_ = inertia_rad_per_s_ = glm::dvec3(0.0);
  zoom_ = 0.0;
}

void Momentum::spend(double dt_s, const HandMapping& hands, ViewState& view) {
  const double fastest = hands.fastest_turn_deg_per_s * kRadPerDeg;
  const double dt = std::min(dt_s, kLongestStepS);
  double asked = glm::length(turn_rad_);
  if (asked > kMostPendingRad) turn_rad_ *= kMostPendingRad / asked;
  asked = std::min(asked, kMostPendingRad);
  zoom_ = std::clamp(zoom_, -kMostPendingZoom, kMostPendingZoom);
  glm::dvec3 now_rad = asked > fastest * dt ? turn_rad_ * (fastest * dt / asked) : turn_rad_;
  turn_rad_ -= now_rad;
  if (asked == 0.0 && glm::length(inertia_rad_per_s_) > 0.0) {
    now_rad = inertia_rad_per_s_ * dt;
    inertia_rad_per_s_ *= std::exp(-dt / hands.inertia_s);
    if (glm::length(inertia_rad_per_s_) < kRestDegPerS * kRadPerDeg) inertia_rad_per_s_ = glm::dvec3(0.0);
  }
  const double most = std::log(hands.fastest_zoom_per_s) * dt;
  const double zoom = std::clamp(zoom_, -most, most);
  zoom_ -= zoom;
  view.zoom *= std::exp(zoom);
  turn_view(view, now_rad);
  moving_ = glm::length(now_rad) > 0.0 || zoom != 0.0;
}

}  // namespace dubsar
