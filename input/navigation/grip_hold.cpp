#include "input/navigation/grip_hold.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace dubsar {
namespace {

constexpr double kShortestM = 0.01;  // between two hands whose distance says a scale

/// The least turn from one direction to another; both have a length.
glm::dquat turn_between(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 a = glm::normalize(from), b = glm::normalize(to);
  const double cosine = glm::dot(a, b);
  if (cosine < -0.999999) {
    const glm::dvec3 across = std::abs(a.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 axis = glm::normalize(glm::cross(a, across));
    return {0.0, axis.x, axis.y, axis.z};
  }
  const glm::dvec3 axis = glm::cross(a, b);
  return glm::normalize(glm::dquat(1.0 + cosine, axis.x, axis.y, axis.z));
}

}  // namespace

bool GripHold::follow(const HandGrips& grips, HeldObject& object, double least, double most) {
  const std::array<bool, 2> before = held_;
  bool anew = false, changed = false;
  for (std::size_t side = 0; side < 2; ++side) {
    const HandGrip& grip = grips[side];
    const bool closed = grip.active && grip.closed;
    const bool was_closed = std::exchange(closed_[side], closed);
    const bool closes = closed && !was_closed;
    const bool reaches =
        glm::distance(grip.pose.position_m, object.centre_m) <= object.radius_m * object.scale + kReachM;
    if (!closed) held_[side] = false;
    if (closes && (reaches || before[1 - side])) held_[side] = anew = true;
    // A runtime that takes a pinching hand for a controller, or back, moves the grip, not the object.
    changed = changed || held_[side] != before[side] || grip.controller != from_[side].controller;
  }
  if (changed) {
    from_ = grips;
    began_ = object;
  }
  if (!holds()) return false;
  if (held_[0] && held_[1]) {
    const glm::dvec3 was = from_[1].pose.position_m - from_[0].pose.position_m;
    const glm::dvec3 is = grips[1].pose.position_m - grips[0].pose.position_m;
    if (glm::length(was) < kShortestM || glm::length(is) < kShortestM) return anew;
    const double scale = std::clamp(began_.scale * glm::length(is) / glm::length(was), least, most);
    const glm::dquat turn = turn_between(was, is);
    const glm::dvec3 middle_was = 0.5 * (from_[0].pose.position_m + from_[1].pose.position_m);
    const glm::dvec3 middle_is = 0.5 * (grips[0].pose.position_m + grips[1].pose.position_m);
    object.centre_m = middle_is + scale / began_.scale * (turn * (began_.centre_m - middle_was));
    object.rotation = glm::normalize(turn * began_.rotation);
    object.scale = scale;
    return anew;
  }
  const std::size_t side = held_[0] ? 0 : 1;
  const glm::dquat turn = grips[side].pose.rotation * glm::conjugate(from_[side].pose.rotation);
  object.centre_m = grips[side].pose.position_m + turn * (began_.centre_m - from_[side].pose.position_m);
  object.rotation = glm::normalize(turn * began_.rotation);
  return anew;
}

}  // namespace dubsar
