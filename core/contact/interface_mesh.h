#pragma once
// The surface between the two clays: triangles whose vertices lie in cells that both share, or belong to the surface of
// the air.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct InterfaceMesh {
  std::vector<Triangle> triangles;  ///< out of the tablet; id < dual positions: one of these, else added[id - count]
  std::vector<glm::vec3> added;     ///< where the density dips, half-way along the edges where nothing is known
  std::vector<float> strength;      ///< of the dip, of each added vertex
  /// Triangle t of each quadrilateral: it was divided into (a, b, c) and, in t + 1, (a, c, d). Which of both diagonals
  /// that is says nothing about the contact.
  std::vector<std::uint32_t> quads;
};

}  // namespace dubsar
