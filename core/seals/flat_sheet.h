#pragma once
// A sheet of points laid flat with the least distortion, and how much that is.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace dubsar {

/// columns x rows points, rows one behind the other; each cell is two triangles.
struct FlatSheet {
  int columns = 0, rows = 0;
  std::vector<glm::dvec3> base_mm, normal;  ///< on the surface
  std::vector<glm::dvec2> flat_mm;          ///< laid flat

  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
  }
};

/// Over the triangles of a sheet. With s1 >= s2 the singular values of the map: length max(|s1 - 1|, |1 - s2|), angle
/// asin((s1 - s2) / (s1 + s2)), the most by which it turns one direction against another.
struct SheetDistortion {
  double length_95 = 0.0, length_most = 0.0;  ///< shares; 95 % of the triangles have less
  double angle_95_deg = 0.0;
};

/// Improves flat_mm, which says roughly where the points go: triangles stay as rigid as they can be (L. Liu et al.: A
/// local/global approach to mesh parameterization, 2008): the best turn of each, then all places at once by conjugate
/// gradients. The sheet's middle row ends up along x from left to right, its least x and y are 0. Deterministic.
/// Cost: some ms a thousand points.
void lay_flat(FlatSheet& sheet);

SheetDistortion distortion_of(const FlatSheet& sheet);

}  // namespace dubsar
