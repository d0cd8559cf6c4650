#include "input/navigation/held_place.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "input/navigation/view_state.h"

namespace dubsar {
namespace {

constexpr double kMostTurn = 120.0;  // radians a height of the pointer's way: eight degrees a pixel of a usual window
constexpr double kNothing = 1e-12;

/// Where the ray of a pointer meets the depth of what it holds.
glm::dvec2 on_ray(const glm::dvec2& pointer, double lever, const std::optional<glm::dvec3>& eye) {
  if (!eye || !(eye->z > 0)) return pointer;
  const glm::dvec2 from(*eye);
  return from + (pointer - from) * ((eye->z - lever) / eye->z);
}

}  // namespace

glm::dvec2 held_at(const InputEvent& event) {
  return event.lever ? on_ray(*event.at, *event.lever, event.eye) : *event.at;
}

HeldPlace::HeldPlace(const InputEvent& event, const glm::dvec2& centre)
    : pointer_(*event.at), at_(held_at(event) - centre, *event.lever), centre_(centre) {
  if (event.eye && event.eye->z > *event.lever) eye_ = *event.eye - glm::dvec3(centre, 0.0);
  near_ = glm::dot(at_, ray_towards(pointer_)) <= 0.0;
}

/// Away from the eye.
glm::dvec3 HeldPlace::ray_towards(const glm::dvec2& at) const {
  return eye_ ? glm::dvec3(at - centre_, 0.0) - *eye_ : glm::dvec3(0.0, 0.0, -1.0);
}

std::optional<glm::dvec3> HeldPlace::follow(const glm::dvec2& by) {
  pointer_ += by;
  const glm::dvec3 along = ray_towards(pointer_), from = eye_.value_or(glm::dvec3(pointer_ - centre_, 0.0));
  const double a = glm::dot(along, along), b = glm::dot(from, along), c = glm::dot(from, from) - glm::dot(at_, at_);
  const double inside = b * b - a * c;
  if (inside < 0.0) return std::nullopt;
  const glm::dvec3 wanted = from + along * ((-b + (near_ ? -1.0 : 1.0) * std::sqrt(inside)) / a);
  const glm::dvec3 step = wanted - at_;
  const double size = std::hypot(step.x, step.y);
  if (size < kNothing) return glm::dvec3(0.0);
  const glm::dvec3 axis(-step.y / size, step.x / size, 0.0);
  const double level = glm::dot(at_, axis);  // of both places: they are as far from the centre
  const glm::dvec3 before = at_ - level * axis, after = wanted - level * axis;
  const double angle = std::atan2(glm::dot(axis, glm::cross(before, after)), glm::dot(before, after));
  const double most = kMostTurn * glm::length(by);
  const glm::dvec3 turn = std::clamp(angle, -most, most) * axis;
  at_ = turn_of(turn) * at_;
  return turn;
}

}  // namespace dubsar
