#pragma once
// Does a surface run through itself? A check that knows nothing of how the surface was made.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace dubsar {

/// Pairs of triangles, the lower first, of which a side of one properly crosses the inside of the other: more than
/// touching. Triangles that share two vertices are neighbours and are not tested. `wanted`: one a triangle, or empty
/// for all; only pairs of which one at least is not 0. A bounding volume hierarchy; about 1 us a wanted triangle, more
/// where the surface is crumpled. Rising, whatever the number of threads.
std::vector<std::array<std::uint32_t, 2>> self_intersections(std::span<const glm::vec3> positions,
                                                             std::span<const std::array<std::uint32_t, 3>> triangles,
                                                             std::span<const std::uint8_t> wanted = {});

/// One such pair; false for triangles that share two vertices.
bool triangles_cross(std::span<const glm::vec3> positions, const std::array<std::uint32_t, 3>& a,
                     const std::array<std::uint32_t, 3>& b);

}  // namespace dubsar
