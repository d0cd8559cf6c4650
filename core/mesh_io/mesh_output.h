#pragma once
// What the writers share: checks before the first byte, and the numbers of a mesh in the unit of the file.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh_io/mesh_io.h"

namespace dubsar {

/// Grid coordinates and curvatures in file units.
class OutputSpace {
 public:
  OutputSpace(const GridFrame& frame, MeshUnits units) : frame_(frame), mm_(units == MeshUnits::kMm) {
    step_ = mm_ ? frame.grid_voxel_mm() : frame.scale;
    curvature_ = static_cast<float>(1.0 / std::cbrt(step_.x * step_.y * step_.z));
  }
  glm::vec3 position(const glm::vec3& grid) const { return glm::vec3(exact_position(grid)); }
  glm::dvec3 exact_position(const glm::vec3& grid) const {
    const glm::dvec3 p(grid);
    return mm_ ? frame_.mm_from_grid(p) : frame_.input_vox_from_grid(p);
  }
  /// Where the mesh lies when it is so far from the origin that float would lose its shape (survey coordinates), in
  /// file units; 0: it is not.
  glm::dvec3 far_origin(const TriMesh& mesh) const;
  /// The same for formats that can only keep what lies near, which is said.
  glm::dvec3 told_origin(const TriMesh& mesh, std::string_view format) const;
  /// Normals turn with the inverse transpose of a stretched grid.
  glm::vec3 normal(const glm::vec3& n) const {
    if (step_.x == step_.y && step_.y == step_.z) return n;
    const glm::dvec3 turned = glm::dvec3(n) / step_;
    const double length = glm::length(turned);
    return length > 0.0 ? glm::vec3(turned / length) : n;
  }
  /// Per grid step to per file unit; the mean step where the grid is stretched.
  float curvature(float k) const { return k * curvature_; }

 private:
  GridFrame frame_;
  bool mm_;
  glm::dvec3 step_{1.0};
  float curvature_ = 1.0f;
};

/// kInternal when arrays have different lengths or triangles name missing vertices, kBadData when a position is not
/// finite.
Result<void> check_tri_mesh(const TriMesh& mesh);

/// One colour per vertex: those of the mesh, else shape colours shaded by ambient light, else empty. `derived` says
/// whether they were computed.
struct VertexColors {
  std::vector<std::array<std::uint8_t, 3>> rgb;
  bool derived = false;
};
VertexColors output_colors(const TriMesh& mesh);

/// Table name of a partition, or "part 3".
std::string partition_name(const TriMesh& mesh, PartitionId id);

}  // namespace dubsar
