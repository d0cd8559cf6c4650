#pragma once
// Meshes with known answers: parametric grids, whose vertices lie exactly on the surface, and dual meshes of analytic
// fields with quantised edge crossings, which carry the errors of the real extraction.

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <tuple>
#include <vector>

#include "core/extract/quad_mesh.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::test {

constexpr double kPi = 3.14159265358979323846;

/// A grid of nu x nv quads over [0,1]^2. `point(u, v)`; u x v directions must give the outward normal. Wrapped
/// directions join their ends.
inline QuadMesh parametric_grid(int nu, int nv, bool wrap_u, bool wrap_v,
                                const std::function<glm::dvec3(double, double)>& point) {
  QuadMesh mesh;
  const int pu = wrap_u ? nu : nu + 1, pv = wrap_v ? nv : nv + 1;
  for (int j = 0; j < pv; ++j)
    for (int i = 0; i < pu; ++i)
      mesh.positions.emplace_back(point(static_cast<double>(i) / nu, static_cast<double>(j) / nv));
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>((j % pv) * pu + i % pu); };
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) mesh.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
  mesh.build_incidence();
  return mesh;
}

/// Sphere from a cube of 6 n^2 quads; 8 vertices have three incident quads, all others four.
inline QuadMesh cube_sphere(int n, double radius, glm::dvec3 centre = glm::dvec3(0.0)) {
  QuadMesh mesh;
  std::map<std::tuple<int, int, int>, std::uint32_t> ids;
  const auto vertex = [&](std::array<int, 3> c) {
    const auto [it, fresh] = ids.try_emplace({c[0], c[1], c[2]}, static_cast<std::uint32_t>(ids.size()));
    if (fresh) {
      glm::dvec3 p;
      for (int a = 0; a < 3; ++a) p[a] = std::tan((2.0 * c[static_cast<std::size_t>(a)] / n - 1.0) * kPi / 4.0);
      mesh.positions.emplace_back(centre + radius * glm::normalize(p));
    }
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int a, int b) {
            std::array<int, 3> c{};
            c[axis] = side * n;
            c[(axis + 1) % 3] = a;
            c[(axis + 2) % 3] = b;
            return vertex(c);
          };
          std::array<std::uint32_t, 4> q{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          if (side == 0) std::swap(q[1], q[3]);
          mesh.quads.push_back(q);
        }
  mesh.build_incidence();
  return mesh;
}

inline QuadMesh torus(int nu, int nv, double ring, double tube) {
  return parametric_grid(nu, nv, true, true, [=](double u, double v) {
    const double a = 2 * kPi * u, b = 2 * kPi * v, r = ring + tube * std::cos(b);
    return glm::dvec3(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
  });
}

/// Dual mesh (one vertex per mixed cell) of inside = field >= 0 on [0,n)^3, crossings quantised to `bits` (0: exact).
/// No split cells: for fields that are smooth at the scale of the grid.
inline QuadMesh dual_mesh(int n, int bits, const std::function<double(glm::dvec3)>& field) {
  QuadMesh mesh;
  const auto at = [n](int x, int y, int z) { return static_cast<std::size_t>((z * n + y) * n + x); };
  std::vector<double> f(static_cast<std::size_t>(n) * n * n);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) f[at(x, y, z)] = field({x, y, z});
  const auto crossing = [&](std::array<int, 3> p, std::size_t axis) {
    auto q = p;
    ++q[axis];
    const double a = f[at(p[0], p[1], p[2])], b = f[at(q[0], q[1], q[2])];
    double t = a / (a - b);
    if (bits > 0) {
      const double steps = std::ldexp(1.0, bits);
      t = (std::min(steps - 1, std::floor(t * steps)) + 0.5) / steps;
    }
    glm::dvec3 c(p[0], p[1], p[2]);
    c[static_cast<int>(axis)] += t;
    return c;
  };
  const auto mixed = [&](std::array<int, 3> p, std::size_t axis) {
    auto q = p;
    ++q[axis];
    return (f[at(p[0], p[1], p[2])] >= 0) != (f[at(q[0], q[1], q[2])] >= 0);
  };
  std::vector<std::uint32_t> id(f.size(), ~0u);
  for (int z = 0; z + 1 < n; ++z)
    for (int y = 0; y + 1 < n; ++y)
      for (int x = 0; x + 1 < n; ++x) {
        glm::dvec3 sum(0.0);
        int count = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> p{x, y, z};
            p[(axis + 1) % 3] += k & 1;
            p[(axis + 2) % 3] += k >> 1;
            if (mixed(p, axis)) sum += crossing(p, axis), ++count;
          }
        if (count == 0) continue;
        id[at(x, y, z)] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.emplace_back(sum / static_cast<double>(count));
      }
  for (int z = 1; z + 1 < n; ++z)
    for (int y = 1; y + 1 < n; ++y)
      for (int x = 1; x + 1 < n; ++x)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::array<int, 3> p{x, y, z};
          if (!mixed(p, axis)) continue;
          std::array<std::uint32_t, 4> q;
          constexpr int kU[4] = {0, -1, -1, 0}, kV[4] = {0, 0, -1, -1};
          for (std::size_t k = 0; k < 4; ++k) {
            auto c = p;
            c[(axis + 1) % 3] += kU[k];
            c[(axis + 2) % 3] += kV[k];
            q[k] = id[at(c[0], c[1], c[2])];
          }
          if (f[at(x, y, z)] < 0) std::swap(q[1], q[3]);  // inside first: the normal runs along the axis
          mesh.quads.push_back(q);
        }
  mesh.build_incidence();
  return mesh;
}

/// Two triangles a quad; for meshes without doubled corners.
inline std::vector<Triangle> split_quads(const QuadMesh& mesh) {
  std::vector<Triangle> triangles;
  for (const auto& q : mesh.quads) {
    triangles.push_back({q[0], q[1], q[2]});
    triangles.push_back({q[0], q[2], q[3]});
  }
  return triangles;
}

}  // namespace dubsar::test
