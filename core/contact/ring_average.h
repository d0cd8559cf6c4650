#pragma once
// Values of the contact's added vertices, averaged along it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/contact/interface_mesh.h"
#include "core/contact/interface_rings.h"

namespace dubsar {

/// work(0) to work(count - 1), on all threads.
template <class Work>
void each_vertex(std::size_t count, const Work& work) {
  parallel_for(static_cast<std::int64_t>(count), 1024, [&](std::int64_t i) { work(static_cast<std::size_t>(i)); });
}

namespace ring_average {
template <class T>
void add(T& sum, const T& v, float weight) {
  sum += weight * v;
}
template <std::size_t N>
void add(std::array<float, N>& sum, const std::array<float, N>& v, float weight) {
  for (std::size_t i = 0; i < N; ++i) sum[i] += weight * v[i];
}
template <class T>
void scale(T& v, float by) {
  v *= by;
}
template <std::size_t N>
void scale(std::array<float, N>& v, float by) {
  for (float& x : v) x *= by;
}
}  // namespace ring_average

/// Each value becomes the mean of itself and of those of the added vertices beside it, by their weights, `rounds`
/// times. The same for any number of threads.
template <class T>
void average_rings(const InterfaceRings& around, int rounds, std::vector<T>& values) {
  std::vector<T> next(values.size());
  for (int round = 0; round < rounds; ++round) {
    each_vertex(values.size(), [&](std::size_t i) {
      next[i] = values[i];
      const float weights =
          around.added.each(i, [&](std::uint32_t w, float weight) { ring_average::add(next[i], values[w], weight); });
      ring_average::scale(next[i], 1.0f / (weights + 1.0f));
    });
    values.swap(next);
  }
}

/// The same for some of the vertices, `rounds` rings around those that matter; the others stay.
template <class T>
void average_rings(const InterfaceRings& around, int rounds, const std::vector<std::uint32_t>& some,
                   std::vector<T>& values) {
  std::vector<T> next(some.size());
  for (int round = 0; round < rounds; ++round) {
    each_vertex(some.size(), [&](std::size_t k) {
      const std::uint32_t i = some[k];
      next[k] = values[i];
      const float weights =
          around.added.each(i, [&](std::uint32_t w, float weight) { ring_average::add(next[k], values[w], weight); });
      ring_average::scale(next[k], 1.0f / (weights + 1.0f));
    });
    each_vertex(some.size(), [&](std::size_t k) { values[some[k]] = next[k]; });
  }
}

/// Normals of the added vertices, towards the envelope, as long as twice the area of the triangles around them, on
/// average over both ways to divide each quadrilateral. The same for any number of threads.
inline std::vector<glm::vec3> area_normals(const InterfaceMesh& mesh, const InterfaceRings& rings,
                                           const std::vector<glm::vec3>& dual_positions) {
  const auto dual = static_cast<std::uint32_t>(dual_positions.size());
  const auto position = [&](std::uint32_t v) { return v < dual ? dual_positions[v] : mesh.added[v - dual]; };
  std::vector<glm::vec3> areas(mesh.triangles.size()), normals(mesh.added.size());
  each_vertex(areas.size(), [&](std::size_t i) {
    const Triangle& t = mesh.triangles[i];
    const glm::vec3 a = position(t[0]);
    areas[i] = glm::cross(position(t[1]) - a, position(t[2]) - a);
  });
  each_vertex(normals.size(), [&](std::size_t i) {
    glm::vec3 normal(0.0f);
    for (const std::uint32_t t : rings.fans.triangles[i]) normal += areas[t];
    // The corner triangle at the other end of a diagonal is what one division has there more than the other.
    for (const std::uint32_t c : rings.fans.corners[i]) {
      const std::size_t k = c % 4;
      const auto corner = corners_of_quad(mesh, mesh.quads[c / 4]);
      const glm::vec3 a = position(corner[(k + 2) % 4]),
                      n = glm::cross(position(corner[(k + 3) % 4]) - a, position(corner[(k + 1) % 4]) - a);
      normal += (k % 2 == 0 ? -0.5f : 0.5f) * n;
    }
    normals[i] = normal;
  });
  return normals;
}

/// The same averaged, and of unit length, or 0 where they cancel out.
inline std::vector<glm::vec3> unit_normals(const InterfaceMesh& mesh, const InterfaceRings& rings,
                                           const std::vector<glm::vec3>& dual_positions, int rounds) {
  std::vector<glm::vec3> normals = area_normals(mesh, rings, dual_positions);
  average_rings(rings, rounds, normals);
  each_vertex(normals.size(), [&](std::size_t i) {
    glm::vec3& n = normals[i];
    n = glm::length(n) > 0.0f ? glm::normalize(n) : glm::vec3(0.0f);
  });
  return normals;
}

}  // namespace dubsar
