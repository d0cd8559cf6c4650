#include "tests/people/body.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace dubsar {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
// Fitts (1954): seconds for a movement = kFittsA + kFittsB * log2(2 D / W); coefficients of free arm movements in the
// air without a support (Bohan et al. 2003 find slopes of .15 to .25 s a bit for pointing at large displays).
constexpr double kFittsA_s = 0.12, kFittsB_s = 0.16, kShortest_s = 0.15;
constexpr double kPinchTime_s = 0.22;
constexpr double kRelaxedPinch_m = 0.055;

/// Minimum jerk from 0 to 1.
double minimum_jerk(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}

}  // namespace

Body draw_body(ScriptRandom& random) {
  Body body;
  const double who = random.uniform(0.0, 1.0);
  const bool child = who<0.25, seated = who> 0.9;
  const double height_m = child ? random.uniform(1.08, 1.45) : random.uniform(1.52, 1.95);
  const double panel_m = 1.1;  // of its centre above the floor: a table for grown-ups and children
  const double eyes_above_floor_m = seated ? 0.72 * height_m : 0.935 * height_m;
  body.arm_m = 0.385 * height_m;  // shoulder to the middle of the palm (Drillis and Contini 1966: .186 + .146 + .05)
  // one steps up to what one wants to touch
  body.eyes_m = {random.uniform(-0.12, 0.12), eyes_above_floor_m - panel_m, body.arm_m * random.uniform(0.85, 1.35)};
  body.shoulders_m = 0.23 * height_m;
  body.size = height_m / 1.72 * random.uniform(0.92, 1.1);
  body.left_handed = random.uniform(0.0, 1.0) < 0.11;
  body.tremor_m = 0.001 * random.uniform(0.2, 1.5);
  body.tremor_hz = random.uniform(7.0, 11.0);
  body.sag_mps = 0.001 * random.uniform(0.0, 9.0);
  body.swiftness = std::exp(0.22 * random.normal());
  body.relaxed_grab = std::clamp(0.12 + 0.1 * random.normal(), 0.0, 0.4);
  // some make a fist, some hold the air as they would hold an object, and never close the hand
  body.closed_grab = random.uniform(0.0, 1.0) < 0.3 ? random.uniform(0.6, 0.82) : random.uniform(0.85, 1.0);
  body.reaction_s = random.uniform(0.22, 0.5);
  body.sleeves = random.uniform(0.0, 1.0) < 0.2;
  return body;
}

glm::dvec3 shoulder_m(const Body& body, bool left) {
  return body.eyes_m + glm::dvec3((left ? -0.5 : 0.5) * body.shoulders_m, -0.33 * body.arm_m - 0.02, 0.08);
}

glm::dvec3 held_up_m(const Body& body, bool left, double stretch, double wants) {
  const glm::dvec3 shoulder = shoulder_m(body, left);
  const glm::dvec3 easy = glm::normalize(glm::dvec3(left ? 0.15 : -0.15, -0.25, -0.95));          // the elbow hangs
  const glm::dvec3 there = glm::normalize(glm::dvec3(left ? -0.05 : 0.05, 0.0, 0.0) - shoulder);  // to the object
  return shoulder + stretch * body.arm_m * glm::normalize(glm::mix(easy, there, wants));
}

Arm::Arm(const Body& body, bool left, std::uint64_t seed) : body_(body), left_(left), random_(seed) {
  phase_ = random_.uniform(0.0, kTwoPi);
}

glm::dvec3 Arm::place_m() const {
  if (!strokes_.empty()) return strokes_.back().to_m;
  return shoulder_m(body_, left_) - glm::dvec3(0.0, body_.arm_m, 0.0);
}

double Arm::stroke(double t_s, const glm::dvec3& to_m, double seconds, bool visible) {
  const double start = std::max(t_s, busy_until_s());
  const glm::dvec3 from = strokes_.empty() ? place_m() : steady_at(start);
  const double way = glm::length(to_m - from);
  const glm::dvec3 bow =
      0.08 * way * glm::dvec3(0.4 * random_.normal(), std::abs(random_.normal()), 0.4 * random_.normal());
  strokes_.push_back({start, start + seconds, from, to_m, bow, visible});
  return start + seconds;
}

double Arm::raise(double t_s, const glm::dvec3& at_m) {
  up_ = true;
  return stroke(t_s, at_m, random_.uniform(0.55, 0.85) / body_.swiftness, true);
}

double Arm::move(double t_s, const glm::dvec3& to_m, double width_m, double hurry) {
  const double way = glm::length(to_m - place_m());
  const double bits = std::log2(std::max(1.0, 2.0 * way / width_m));
  const double seconds = std::max(kShortest_s, (kFittsA_s + kFittsB_s * bits) / (body_.swiftness * hurry));
  const glm::dvec3 miss = 0.04 * way * glm::dvec3(random_.normal(), random_.normal(), random_.normal());
  return stroke(t_s, to_m + miss, seconds, true);
}

double Arm::hold(double t_s, double seconds) {
  return stroke(t_s, strokes_.empty() ? place_m() : steady_at(std::max(t_s, busy_until_s())), seconds, up_);
}

double Arm::lower(double t_s) {
  const glm::dvec3 hip = shoulder_m(body_, left_) - glm::dvec3(0.0, body_.arm_m, 0.05);
  grip(t_s, random_.uniform(0.0, 0.7));  // nobody minds his fingers any more
  const double end = stroke(t_s, hip, random_.uniform(0.5, 0.9), true);
  up_ = false;
  strokes_.push_back({end, end, hip, hip, glm::dvec3(0.0), false});
  return end;
}

const Arm::Change* Arm::change_at(const std::vector<Change>& changes, double t_s) {
  const auto after =
      std::upper_bound(changes.begin(), changes.end(), t_s, [](double t, const Change& c) { return t < c.start_s; });
  return after == changes.begin() ? nullptr : &*(after - 1);
}

double Arm::value_at(const std::vector<Change>& changes, double t_s, double rest,
                     double RecordedFingers::State::*what) {
  const Change* const now = change_at(changes, t_s);
  if (now == nullptr) return rest;
  return now->from + (now->to - now->from) * (now->as->at((t_s - now->start_s) / (now->end_s - now->start_s)).*what);
}

glm::dvec3 Arm::palm_at(double t_s) const {
  const Change* const now = change_at(grips_, t_s);
  if (now == nullptr) return glm::dvec3(0.0);
  const double part = (t_s - now->start_s) / (now->end_s - now->start_s);
  glm::dvec3 went = body_.size * std::abs(now->to - now->from) * now->as->at(part).went_m;
  if (left_) went.x = -went.x;
  return (1.0 - std::clamp(part, 0.0, 1.0)) * now->palm_m + went;
}

const RecordedFingers& Arm::some_fingers(bool close) {
  std::vector<const RecordedFingers*> fit;
  for (const RecordedFingers& each : recorded_fingers())
    if ((each.kind == RecordedFingers::kCloses) == close) fit.push_back(&each);
  const auto drawn = static_cast<std::size_t>(random_.uniform(0.0, static_cast<double>(fit.size())));
  return *fit[std::min(drawn, fit.size() - 1)];
}

double Arm::grip(double t_s, double effort) {
  const double to = std::clamp(
      body_.relaxed_grab + (body_.closed_grab - body_.relaxed_grab) * effort + 0.03 * random_.normal(), 0.0, 1.0);
  const double start = grips_.empty() ? t_s : std::max(t_s, grips_.back().end_s);
  const double from = value_at(grips_, start, body_.relaxed_grab, &RecordedFingers::State::grab);
  const RecordedFingers& as = some_fingers(to > from);
  const double seconds = as.there_s * random_.uniform(0.7, 1.4) / body_.swiftness;
  // the same movement brings the thumb to the index finger
  const double pinch_to = std::max(0.015, kRelaxedPinch_m * body_.size * (1.0 - 0.7 * to));
  const double pinch_from = value_at(pinches_, start, kRelaxedPinch_m * body_.size, &RecordedFingers::State::pinch);
  pinches_.push_back({start, start + seconds, pinch_from, pinch_to, &as, glm::dvec3(0.0)});
  grips_.push_back({start, start + seconds, from, to, &as, palm_at(start)});
  return start + seconds;
}

double Arm::pinch(double t_s, double distance_m) {
  const double start = pinches_.empty() ? t_s : std::max(t_s, pinches_.back().end_s);
  const double from = value_at(pinches_, start, kRelaxedPinch_m * body_.size, &RecordedFingers::State::pinch);
  const double end = start + kPinchTime_s * random_.uniform(0.8, 1.4) / body_.swiftness;
  pinches_.push_back({start, end, from, distance_m, &some_fingers(distance_m < from), glm::dvec3(0.0)});
  return end;
}

void Arm::point(double t_s, bool stretched) { bends_.emplace_back(t_s, stretched); }

double Arm::bent_at(double t_s) const {
  const auto after = std::upper_bound(bends_.begin(), bends_.end(), t_s,
                                      [](double t, const std::pair<double, bool>& bend) { return t < bend.first; });
  if (after == bends_.begin()) return 1.0;
  const double moved = minimum_jerk((t_s - (after - 1)->first) / kPinchTime_s);
  return (after - 1)->second ? 1.0 - moved : moved;
}

const Arm::Stroke* Arm::stroke_at(double t_s) const {
  const auto after = std::upper_bound(strokes_.begin(), strokes_.end(), t_s,
                                      [](double t, const Stroke& stroke) { return t < stroke.start_s; });
  return after == strokes_.begin() ? nullptr : &*(after - 1);
}

glm::dvec3 Arm::steady_at(double t_s) const {
  const Stroke* const now = stroke_at(t_s);
  if (now == nullptr) return place_m();
  const double s = now->end_s > now->start_s ? minimum_jerk((t_s - now->start_s) / (now->end_s - now->start_s)) : 1.0;
  const double held_s = now->from_m == now->to_m ? t_s - now->start_s : t_s - now->end_s;
  return glm::mix(now->from_m, now->to_m, s) + now->bow_m * (4.0 * s * (1.0 - s)) -
         glm::dvec3(0.0, body_.sag_mps * std::clamp(held_s, 0.0, 8.0), 0.0);
}

std::optional<HandAsItIs> Arm::at(double t_s) const {
  const Stroke* const now = stroke_at(t_s);
  if (now == nullptr || !now->visible) return std::nullopt;
  HandAsItIs hand;
  glm::dvec3& at = hand.palm.position_m;
  at = steady_at(t_s) + palm_at(t_s);
  const double angle = kTwoPi * body_.tremor_hz * t_s + phase_;
  at += body_.tremor_m * glm::dvec3(std::sin(angle), std::sin(1.13 * angle + 1.0), std::sin(0.87 * angle + 2.0));
  // the fingers go on where the arm points, bent half way back to the screen's normal by the wrist
  const glm::dvec3 arm = at - shoulder_m(body_, left_);
  const double yaw = -0.6 * std::atan2(arm.x, -arm.z), pitch = 0.4 * std::atan2(arm.y, std::hypot(arm.x, arm.z));
  hand.palm.rotation = glm::angleAxis(yaw, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch, glm::dvec3(1, 0, 0));
  hand.grab = std::clamp(value_at(grips_, t_s, body_.relaxed_grab, &RecordedFingers::State::grab), 0.0, 1.0);
  hand.index = hand.grab * bent_at(t_s);
  hand.pinch_m = value_at(pinches_, t_s, kRelaxedPinch_m * body_.size, &RecordedFingers::State::pinch);
  return hand;
}

}  // namespace dubsar
