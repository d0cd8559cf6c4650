#include "core/script/text_sides.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {

glm::dvec3 TextSides::normal_of(TextSide side) const {
  switch (side) {
    case TextSide::kObverse:
      return frame_.front;
    case TextSide::kReverse:
      return -frame_.front;
    case TextSide::kLowerEdge:
      return -frame_.up;
    case TextSide::kUpperEdge:
      return frame_.up;
    case TextSide::kLeftEdge:
      return -frame_.right;
    case TextSide::kRightEdge:
      break;
  }
  return frame_.right;
}

TextSide TextSides::side_of(const glm::dvec3& normal) const {
  TextSide best = TextSide::kObverse;
  for (std::size_t s = 1; s < kTextSideCount; ++s) {
    const auto side = static_cast<TextSide>(s);
    if (glm::dot(normal_of(side), normal) > glm::dot(normal_of(best), normal)) best = side;
  }
  return best;
}

glm::dvec3 TextSides::usual_right(TextSide side) const {
  if (side == TextSide::kLeftEdge) return -frame_.up;
  if (side == TextSide::kRightEdge) return -frame_.front;
  return frame_.right;
}

glm::dvec3 TextSides::right_of(TextSide side) const {
  glm::dvec3 right = usual_right(side);
  const glm::dvec3 normal = normal_of(side);
  for (int k = 0; k < (turned(side) % 4 + 4) % 4; ++k) right = glm::cross(normal, right);
  return right;
}

glm::dvec3 TextSides::up_of(TextSide side) const { return glm::cross(normal_of(side), right_of(side)); }

glm::dvec3 TextSides::right_at(const glm::dvec3& normal) const {
  const TextSide side = side_of(normal);
  const glm::dvec3 right = right_of(side), flat = right - normal * glm::dot(right, normal);
  if (glm::length(flat) > 0.3) return glm::normalize(flat);
  return glm::normalize(glm::cross(up_of(side), normal));
}

SideAngle TextSides::angle_of(const glm::dvec3& direction, const glm::dvec3& normal) const {
  const glm::dvec3 right = right_at(normal), up = glm::cross(normal, right);
  return {side_of(normal), std::atan2(glm::dot(direction, up), glm::dot(direction, right))};
}

}  // namespace dubsar
