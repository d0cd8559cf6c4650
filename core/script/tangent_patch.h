#pragma once
// The relief around a place, seen along the surface's normal there, and how deep it lies below the writing surface.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Triangles of a mesh by cells of space, without those that are inferred. All lengths in mm.
class PatchCells {
 public:
  /// Cells are a two-hundredth of its longest extent. Keeps no reference. Cost: some 50 ns a triangle.
  explicit PatchCells(const TriMesh& mesh);
  PatchCells(std::vector<glm::vec3> points_mm, std::vector<Triangle> triangles);

  struct Tile {
    glm::dvec3 middle{0.0}, normal{0, 0, 1};
  };
  /// One for each cube of this size (rounded to whole cells) that has surface: the mean of it, and the mean normal of
  /// what looks the same way around.
  std::vector<Tile> tiles(double tile_mm) const;
  double cell_mm() const noexcept { return cell_mm_; }
  glm::dvec3 extent_mm() const { return high_ - low_; }
  double area_mm2() const noexcept { return area_; }
  double mean_edge_mm() const noexcept { return edge_; }
  bool empty() const noexcept { return triangles_.empty(); }

  /// Calls with the three corners of each triangle whose first corner is in a cell within `reach` of a place.
  template <class Visit>
  void visit(const glm::dvec3& middle, double reach, const Visit& visit) const {
    std::array<std::int64_t, 3> from{}, to{};
    for (int a = 0; a < 3; ++a) {
      from[static_cast<std::size_t>(a)] = cell_of(a, middle[a] - reach);
      to[static_cast<std::size_t>(a)] = cell_of(a, middle[a] + reach);
    }
    for (std::int64_t z = from[2]; z <= to[2]; ++z)
      for (std::int64_t y = from[1]; y <= to[1]; ++y) {  // cells of a row lie beside each other
        const std::uint32_t end = starts_[index(to[0], y, z) + 1];
        for (std::uint32_t i = starts_[index(from[0], y, z)]; i < end; ++i) {
          const Triangle& t = triangles_[i];
          visit(points_[t[0]], points_[t[1]], points_[t[2]], t);
        }
      }
  }
  glm::dvec3 low_mm() const noexcept { return low_; }
  const std::vector<glm::vec3>& points() const noexcept { return points_; }
  const std::vector<Triangle>& triangles() const noexcept { return triangles_; }  ///< by cells

 private:
  void sort_into_cells(const std::vector<Triangle>& kept);
  std::int64_t cell_of(int axis, double at) const;
  std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return static_cast<std::size_t>((z * cells_[1] + y) * cells_[0] + x);
  }

  double cell_mm_ = 1.0, area_ = 0.0, edge_ = 0.0;
  glm::dvec3 low_{0.0}, high_{0.0};
  std::array<std::int64_t, 3> cells_{};
  std::vector<glm::vec3> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> starts_;
};

struct PatchSize {
  int half = 30;         ///< samples from the middle to the border
  double step_mm = 0.1;  ///< between samples
  double ball_mm = 1.0;  ///< radius of the ball that is rolled over the surface from outside
};

/// A square of (2 half + 1)^2 samples of the surface, rows along `up`.
struct TangentPatch {
  glm::dvec3 origin{0.0}, right{1, 0, 0}, up{0, 1, 0}, out{0, 0, 1};
  int half = 0;
  double step_mm = 1.0;
  std::vector<float> depth;  ///< mm below `level`; NaN: nothing is known
  std::vector<float> level;  ///< the writing surface, mm along `out`; NaN as well

  int side() const noexcept { return 2 * half + 1; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y + half) * static_cast<std::size_t>(side()) + static_cast<std::size_t>(x + half);
  }
  glm::dvec3 on_level(int x, int y) const {
    return origin + right * (x * step_mm) + up * (y * step_mm) + out * static_cast<double>(level[index(x, y)]);
  }
};

/// The surface around `middle` as seen against `normal`; the writing surface is what a ball of the size's radius
/// touches from outside: a closing by a paraboloid (Haralick, Sternberg, Zhuang: Image analysis using mathematical
/// morphology, 1987), separable. Cost: some ns for each triangle and sample, 100 ns a sample for the closing.
TangentPatch tangent_patch(const PatchCells& cells, const glm::dvec3& middle, const glm::dvec3& normal,
                           const PatchSize& size);

}  // namespace dubsar
