#pragma once
// What a mesh file says about itself in words: the same lines serve as PLY comments and OBJ comments.

#include <string>
#include <string_view>
#include <vector>

#include "core/mesh_io/mesh_io.h"

namespace dubsar {

/// Lines without comment marks, at most 200 characters of provenance each: maker, unit, voxel size, colours, partition
/// table, provenance. `colors_derived`: the colours of the file were computed from shape and ambient light.
std::vector<std::string> mesh_text_lines(const TriMesh& mesh, const MeshWriteOptions& options, bool colors_derived);

/// Collects such lines from a file.
class MeshTextReader {
 public:
  void line(std::string_view text);
  bool ours() const noexcept { return ours_; }
  bool colors_derived() const noexcept { return colors_derived_; }
  /// Sets frame, partitions and provenance. kBadData when a partition line is broken.
  Result<void> apply(TriMesh& mesh) const;

 private:
  bool ours_ = false, colors_derived_ = false, unit_mm_ = false, unit_vox_ = false, size_known_ = false;
  glm::dvec3 voxel_mm_{1.0};
  std::string voxel_provenance_, provenance_;
  std::vector<std::string> partitions_;
};

}  // namespace dubsar
