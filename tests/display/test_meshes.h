#pragma once
// Meshes with known answers, for the tests of this room.

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/mesh/tri_mesh.h"

namespace dubsar::testing {

/// Latitude-longitude sphere around the origin with exact normals.
inline TriMesh sphere(float radius, int rings, int segments) {
  TriMesh mesh;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double theta = std::numbers::pi * r / rings, phi = 2 * std::numbers::pi * s / segments;
      const glm::vec3 n(glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
      mesh.positions.push_back(radius * n);
      mesh.normals.push_back(n);
    }
  const auto id = [&](int r, int s) { return static_cast<std::uint32_t>(r * segments + s % segments); };
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      if (r > 0) mesh.triangles.push_back({id(r, s), id(r + 1, s), id(r, s + 1)});
      if (r < rings - 1) mesh.triangles.push_back({id(r, s + 1), id(r + 1, s), id(r + 1, s + 1)});
    }
  return mesh;
}

/// Adds the rectangle corner + [0, 1] u + [0, 1] v, counter-clockwise seen from u x v, in one partition.
inline void add_rectangle(TriMesh& mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v, std::uint8_t partition) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::vec3& p : {corner, corner + u, corner + u + v, corner + v}) {
    mesh.positions.push_back(p);
    mesh.normals.push_back(glm::normalize(glm::cross(u, v)));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  mesh.triangle_partition.insert(mesh.triangle_partition.end(), 2, partition);
}

/// A box of size (40, 30, 10) around the origin whose faces are partitions 0 to 5: +z (front), -z (back), -x (left),
/// +x (right), +y (top), -y (bottom). On each face, slightly raised, a letter F in partition 6 stands upright and the
/// right way round for the viewer of that view: the stem on the left, the bars to the right, the long bar on top.
inline TriMesh lettered_box() {
  TriMesh mesh;
  const glm::vec3 half(20, 15, 5);
  struct Face {
    glm::vec3 right, up;
  };
  const std::array<Face, 6> faces{{{{1, 0, 0}, {0, 1, 0}},    // front, seen from +z
                                   {{-1, 0, 0}, {0, 1, 0}},   // back
                                   {{0, 0, 1}, {0, 1, 0}},    // left, seen from -x
                                   {{0, 0, -1}, {0, 1, 0}},   // right
                                   {{1, 0, 0}, {0, 0, -1}},   // top, seen from +y, the front down
                                   {{1, 0, 0}, {0, 0, 1}}}};  // bottom, the front up
  for (std::uint8_t f = 0; f < 6; ++f) {
    const glm::vec3 r = faces[f].right, u = faces[f].up, n = glm::cross(r, u);
    const float w = std::abs(glm::dot(half, r)), h = std::abs(glm::dot(half, u)), d = std::abs(glm::dot(half, n));
    add_rectangle(mesh, -w * r - h * u + d * n, 2 * w * r, 2 * h * u, f);
    const auto part = [&](float x0, float y0, float x1, float y1) {  // fractions of the face, from its lower left
      add_rectangle(mesh, (2 * x0 - 1) * w * r + (2 * y0 - 1) * h * u + (d + 0.05f) * n, 2 * (x1 - x0) * w * r,
                    2 * (y1 - y0) * h * u, 6);
    };
    part(0.3f, 0.2f, 0.4f, 0.8f);
    part(0.4f, 0.7f, 0.7f, 0.8f);
    part(0.4f, 0.45f, 0.55f, 0.55f);
  }
  return mesh;
}

}  // namespace dubsar::testing
