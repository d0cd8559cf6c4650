#pragma once
// The triangles and quadrilaterals around each vertex that the contact added, so that sums over them can be made by all
// threads, in the order of the mesh.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/interface_mesh.h"

namespace dubsar {

/// The corners of a quadrilateral (interface_mesh.h), or all of them one where it is none any more.
inline std::array<std::uint32_t, 4> corners_of_quad(const InterfaceMesh& mesh, std::uint32_t first) {
  const Triangle &t = mesh.triangles[first], &u = mesh.triangles[first + 1];
  if (t[0] != u[0] || t[2] != u[1]) return {t[0], t[0], t[0], t[0]};
  return {t[0], t[1], t[2], u[2]};
}

/// Lists of numbers, one for each of some things, rising, in one piece of memory.
class FanLists {
 public:
  /// each(visit) calls visit(i, number) for all numbers of all lists, those of one list in their order.
  template <class Each>
  FanLists(std::size_t lists, const Each& each) : first_(lists + 1, 0) {
    each([&](std::size_t i, std::uint32_t) { ++first_[i + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    numbers_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    each([&](std::size_t i, std::uint32_t number) { numbers_[next[i]++] = number; });
  }
  std::span<const std::uint32_t> operator[](std::size_t i) const noexcept {
    return std::span(numbers_).subspan(first_[i], first_[i + 1] - first_[i]);
  }

 private:
  std::vector<std::uint32_t> first_, numbers_;
};

struct VertexFans {
  FanLists triangles;  ///< at each added vertex
  FanLists corners;    ///< 4 i + k: it is corner k of mesh.quads[i]

  VertexFans(const InterfaceMesh& mesh, std::uint32_t dual)
      : triangles(mesh.added.size(),
                  [&](const auto& visit) {
                    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
                      for (const std::uint32_t v : mesh.triangles[t])
                        if (v >= dual) visit(v - dual, t);
                  }),
        corners(mesh.added.size(), [&](const auto& visit) {
          for (std::uint32_t i = 0; i < mesh.quads.size(); ++i) {
            const auto corner = corners_of_quad(mesh, mesh.quads[i]);
            for (std::uint32_t k = 0; k < 4; ++k)
              if (corner[k] >= dual) visit(corner[k] - dual, 4 * i + k);
          }
        }) {}
};

}  // namespace dubsar
