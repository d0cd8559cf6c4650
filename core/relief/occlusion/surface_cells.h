#pragma once
// Places of a surface with their areas, sorted into cells of space, for sums over what lies around a point.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace dubsar {

/// A small piece of surface: its middle, and its area along its normal.
struct SurfaceElement {
  glm::vec3 at{0.0f}, area{0.0f};  ///< mm, mm2
};

/// Places within one cube of `cell` and of one octant of normals become one: areas added, middles weighted by them.
/// As they are where that saves less than a quarter of them. Deterministic.
std::vector<SurfaceElement> merged_elements(const std::vector<SurfaceElement>& places, double cell);

/// Sums of x . area around a point, x being the way to a place: over those nearer than the first radius and over all,
/// as they are (`plain`) and divided by |x|^3 (`third`).
struct BandSums {
  float plain_first = 0.0f, plain_all = 0.0f, third_first = 0.0f, third_all = 0.0f;
};

class SurfaceCells {
 public:
  /// For sums of at most `reach`.
  SurfaceCells(std::vector<SurfaceElement> places, double reach);
  /// Over places from `from` to `to` away; `first` lies between them. Any thread.
  BandSums sums(const glm::vec3& point, float from, float first, float to) const;

 private:
  glm::ivec3 cell_of(const glm::vec3& at) const;

  glm::vec3 corner_{0.0f};
  float cell_ = 1.0f;
  glm::ivec3 cells_{1};
  std::vector<std::uint32_t> begin_;           ///< of each cell, x fastest, and the end
  std::array<std::vector<float>, 6> columns_;  ///< x, y, z of the places, then of their areas
};

}  // namespace dubsar
