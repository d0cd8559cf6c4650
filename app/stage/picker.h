#pragma once
// What of a surface is under the pointer.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"
#include "display/render/shading.h"

namespace dubsar::app {

struct Ray {
  glm::dvec3 from{0.0}, direction{0.0, 0.0, -1.0};
};

struct Picked {
  glm::dvec3 at_mm{0.0}, normal{0.0};  ///< normal: unit, of the triangle, towards the air
  std::size_t triangle = 0;
};

/// Knows where runs of triangles lie, as they follow one another in the mesh: on surfaces most rays pass all but a few
/// runs. Borrows the mesh. Making it takes one pass over the triangles, 28 bytes for each 128.
class Picker {
 public:
  explicit Picker(const TriMesh& mesh);

  /// The nearest place where a ray meets the visible parts of the mesh, both in mm of the model; none: it passes by.
  /// What `clips` (of the model's frame) cut away is passed. The same as if every triangle were looked at; of those at
  /// the same place the first.
  std::optional<Picked> pick(const PartLooks& parts, const Ray& ray, std::span<const ClipPlane> clips = {}) const;

 private:
  struct Run {
    glm::vec3 low{0.0f}, high{0.0f};            ///< grid coordinates
    PartitionId first_part = 0, last_part = 0;  ///< of its triangles, the lowest and the highest
  };
  const TriMesh& mesh_;
  std::vector<Run> runs_;
};

}  // namespace dubsar::app
