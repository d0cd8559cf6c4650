#pragma once
// A hole with islands in it: where tablet and envelope touch all round a place where they do not, that place has a rim
// of its own. Bridges join the rims, so that one patch closes the hole.

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace dubsar {

/// The rim of a hole in the sense of the patch that will close it, or several, with bridges between them that are
/// walked to and fro.
struct HoleRim {
  std::vector<std::uint32_t> vertices;
  std::vector<glm::vec3> normals;  ///< to continue beyond the step from each vertex to the next, 0 on bridges; or empty
  std::uint32_t piece = 0;         ///< of the surface around it
};

/// Joins one rim of each island (`island`, by piece) with the nearest of another piece, until every island hangs
/// together with one piece that is none. `members` of the result are indices into `rims`, the first is where the others
/// went. A bridge starts and ends at vertices that `may_bridge` allows, both of them. Time: the product of the lengths
/// of rims of islands and all others.
struct JoinedRims {
  HoleRim rim;
  std::vector<std::uint32_t> members;
};
std::vector<JoinedRims> join_islands(std::vector<HoleRim> rims, const std::vector<bool>& island,
                                     std::span<const glm::vec3> positions,
                                     const std::function<bool(std::uint32_t, std::uint32_t)>& may_bridge);

}  // namespace dubsar
