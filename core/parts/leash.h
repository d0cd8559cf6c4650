#pragma once
// How free vertices are to move, where moving them has made a patch run through something.

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace dubsar {

/// Of each of `points`: 0 within 1.5 grid steps of a place, 1 from 4 on.
std::vector<float> leashes(std::span<const glm::vec3> points, std::span<const glm::vec3> places);

}  // namespace dubsar
