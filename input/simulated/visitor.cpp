#include "input/simulated/visitor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/numbers/angle.h"

namespace dubsar {
namespace {

constexpr double kDeadZoneM = 0.010, kRollDeadRad = 0.105;  // what it takes until the object follows
constexpr double kContentRad = 2.0 * kRadPerDeg, kContentRollRad = 2.5 * kRadPerDeg, kVisitorContentZoom = 0.02;
constexpr double kFistPinchM = 0.015, kOpenPinchM = 0.06;
constexpr std::size_t kRight = 0, kLeft = 1;

HandKey with_grab(HandKey key, double grab) {
  key.grab = grab;
  key.pinch_m = kOpenPinchM + grab * (kFistPinchM - kOpenPinchM);
  return key;
}

}  // namespace

SimulatedVisitor::SimulatedVisitor(const VisitorGoal& goal, std::uint64_t seed)
    : goal_(goal),
      wished_(turn_of({goal.pitch_deg * kRadPerDeg, 0, 0}) * turn_of({0, goal.yaw_deg * kRadPerDeg, 0})),
      random_(seed),
      gain_deg_per_mm_(0.5 * random_.uniform(0.85, 1.15)) {
  hands_[kLeft].chirality = Chirality::kLeft;
  hands_[kLeft].shoulder_m.x = -hands_[kRight].shoulder_m.x;
  busy_until_s_ = random_.uniform(0.2, 0.8);
}

void SimulatedVisitor::hold(double seconds) {
  busy_until_s_ += seconds;
  for (std::size_t h = 0; h < (left_in_ ? 2u : 1u); ++h)
    if (hands_[h].keys.back().t_s < busy_until_s_) {
      HandKey key = hands_[h].keys.back();
      key.t_s = busy_until_s_;
      hands_[h].keys.push_back(key);
    }
}

void SimulatedVisitor::move(std::size_t hand, const glm::dvec3& to, double seconds) {
  HandKey key = hands_[hand].keys.back();
  key.t_s = busy_until_s_ + seconds;
  key.at_m = to;
  hands_[hand].keys.push_back(key);
}

void SimulatedVisitor::close(double seconds, bool both, double grab) {
  for (std::size_t h = 0; h < (both ? 2u : 1u); ++h) {
    HandKey key = with_grab(hands_[h].keys.back(), grab);
    key.t_s = busy_until_s_ + seconds * random_.uniform(0.7, 1.0);
    key.at_m += 0.001 * glm::dvec3(random_.normal(), random_.normal(), random_.normal());  // a closing hand drifts
    hands_[h].keys.push_back(key);
  }
  hold(seconds);
}

void SimulatedVisitor::stroke(const glm::dvec3& error_rad) {
  glm::dvec2 way = glm::dvec2(error_rad.y, -error_rad.x) / kRadPerDeg / gain_deg_per_mm_ * 1e-3;
  const double length = std::min(glm::length(way) * random_.uniform(0.9, 1.1), 0.13);
  way = glm::normalize(way) * (length + kDeadZoneM);
  const glm::dvec3 from = hands_[kRight].keys.back().at_m;
  close(0.2, false, 1.0);
  hold(0.1);
  const double seconds = std::max(0.4, glm::length(way) / random_.uniform(0.1, 0.2));
  move(kRight, from + glm::dvec3(way, 0.02 * random_.normal() * length / 0.13), seconds);
  hold(seconds);
  hold(random_.uniform(0.15, 0.3));
  close(0.2, false, 0.0);
  const double back = std::max(0.4, glm::length(way) / random_.uniform(0.15, 0.3));
  const glm::dvec3 rest{random_.uniform(0.04, 0.12), random_.uniform(-0.04, 0.04), random_.uniform(0.2, 0.3)};
  move(kRight, rest, back);
  hold(back);
}

void SimulatedVisitor::two_hands(double zoom_error, double roll_error_rad) {
  const double span = zoom_error > 0 ? 0.20 : 0.40;
  const glm::dvec3 middle{0.0, 0.0, 0.25};
  const bool zooms = std::abs(zoom_error) > kVisitorContentZoom, rolls = std::abs(roll_error_rad) > kContentRollRad;
  hands_[kLeft].keys = {with_grab({busy_until_s_ + 0.1, middle - glm::dvec3(span / 2, 0, 0)}, 0.0)};
  left_in_ = true;
  move(kRight, middle + glm::dvec3(span / 2, 0, 0), 0.7);
  hold(0.7 + random_.uniform(0.0, 0.2));
  close(0.25, true, 1.0);
  hold(0.1);
  double to = span;
  if (zooms) to = (span + std::copysign(kDeadZoneM, zoom_error)) * std::exp(std::clamp(zoom_error, -0.8, 0.8));
  const double angle =
      rolls ? std::clamp(roll_error_rad, -0.7, 0.7) + std::copysign(kRollDeadRad, roll_error_rad) : 0.0;
  const glm::dvec3 half = 0.5 * to * glm::dvec3(std::cos(angle), std::sin(angle), 0);
  const double seconds = std::max({0.5, std::abs(to - span) / 0.15, std::abs(angle) / 0.7});
  move(kRight, middle + half, seconds);
  move(kLeft, middle - half, seconds);
  hold(seconds);
  hold(random_.uniform(0.2, 0.4));
  close(0.25, true, 0.0);
  move(kLeft, middle - half - glm::dvec3(0.1, 0.15, -0.1), 0.5);
  move(kRight, glm::dvec3(0.08, 0.0, 0.25), 0.8);
  left_in_ = false;
  hold(0.8);
}

void SimulatedVisitor::look(double t_s, const ViewState& seen) {
  if (gone_ || t_s < busy_until_s_) return;
  if (!entered_) {
    entered_ = true;
    busy_until_s_ = t_s;
    const glm::dvec3 at{random_.uniform(0.04, 0.12), random_.uniform(-0.04, 0.04), random_.uniform(0.2, 0.3)};
    hands_[kRight].keys = {with_grab({t_s, at + glm::dvec3(0.05, -0.1, 0.1)}, 0.0)};
    move(kRight, at, 0.5);
    hold(0.5 + random_.uniform(0.35, 0.6));
    return;
  }
  const glm::dvec3 error = vector_of(wished_ * glm::conjugate(seen.rotation));
  const double zoom_error = std::log(goal_.zoom / seen.zoom);
  const bool turned = std::hypot(error.x, error.y) <= kContentRad;
  content_ = turned && std::abs(error.z) <= kContentRollRad && std::abs(zoom_error) <= kVisitorContentZoom;
  if (content_ || t_s > goal_.patience_s) {
    gone_ = true;
    return;
  }
  busy_until_s_ = t_s;
  hold(random_.uniform(0.2, 0.35));  // thinking
  // A large turn first: what it leaves over as roll and zoom goes to both hands.
  if (std::hypot(error.x, error.y) > 15.0 * kRadPerDeg ||
      (!turned && std::abs(error.z) <= kContentRollRad && std::abs(zoom_error) <= kVisitorContentZoom)) {
    stroke(error);
  } else {
    two_hands(zoom_error, error.z);
  }
  hold(random_.uniform(0.25, 0.4));  // watching it come to rest
}

void add_bystanders(Script& script) {
  ScriptRandom random(script.seed * 7919 + 13);
  if (script.bystanders > 0 && script.bystander_heads && script.heads.empty())  // the camera sees the visitor too
    script.heads.push_back({0.063, {{0.0, {0.0, 0.05, 0.65}}, {script.duration_s, {0.02, 0.05, 0.62}}}});
  for (int b = 0; b < script.bystanders; ++b) {
    const double side = (b % 2 == 0) == (script.seed % 2 == 0) ? 1.0 : -1.0;
    const glm::dvec3 head{side * random.uniform(0.4, 0.65), random.uniform(-0.05, 0.2), random.uniform(0.75, 1.1)};
    if (script.bystander_heads)
      script.heads.push_back({0.063, {{1.0, head}, {script.duration_s, head + glm::dvec3(-0.05 * side, 0, -0.1)}}});
    for (double t = random.uniform(2.5, 4.0); t + 4.0 < script.duration_s; t += random.uniform(3.0, 6.0)) {
      HandTrack hand;
      hand.chirality = random.uniform(0, 1) < 0.5 ? Chirality::kLeft : Chirality::kRight;
      hand.shoulder_m = head + glm::dvec3(hand.chirality == Chirality::kLeft ? -0.2 : 0.2, -0.25, 0);
      const auto spot = [&] {
        return glm::dvec3(side * random.uniform(-0.05, 0.3), random.uniform(-0.1, 0.1), random.uniform(0.15, 0.4));
      };
      HandKey key{t, spot() + glm::dvec3(0.2 * side, -0.1, 0.15)};
      hand.keys.push_back(key);
      for (int i = 0; i < 6; ++i) {
        key.t_s += random.uniform(0.25, 0.5);
        if (i > 0) key.at_m = spot();
        key = with_grab(key, i % 3 == 0 ? 0.0 : 1.0);
        hand.keys.push_back(key);
      }
      script.hands.push_back(hand);
    }
  }
}

}  // namespace dubsar
