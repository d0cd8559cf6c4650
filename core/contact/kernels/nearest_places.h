#pragma once
// Which of some places is nearest to each point of a brick, by vector instructions.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace dubsar {

inline constexpr std::int32_t kNearestEdge = 8;  ///< points along an edge of the brick

/// Places in the same order in each span.
struct PlacesByAxis {
  std::span<const float> x, y, z;
};

/// Of each point of the brick whose first is `corner`, along x, then y, then z, the nearest of at least one place; of
/// those that are as near the first. The same on every processor.
void nearest_places(const PlacesByAxis& places, const glm::vec3& corner,
                    std::array<std::int32_t, kNearestEdge * kNearestEdge * kNearestEdge>& nearest);

}  // namespace dubsar
