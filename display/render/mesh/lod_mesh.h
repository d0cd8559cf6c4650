#pragma once
// A mesh in graphics memory in several levels of detail: coarse ones for small or moving pictures.

#include <array>
#include <memory>
#include <vector>

#include "core/base/result.h"
#include "display/render/mesh/gpu_mesh.h"

namespace dubsar {

/// One GL thread.
class LodMesh {
 public:
  /// The mesh as it is, alone. Errors of GpuMesh::upload.
  static Result<LodMesh> exact(const PackedMesh& mesh);
  /// A quick level of 1/90 of its longest side at once (small meshes: as they are). The rest is made in a thread of its
  /// own, which the first update() begins, so that nothing stands in the way of a first picture, and comes in by
  /// update(): the mesh as it is, its triangles in another order, then by grids of 1/1024 to 1/64 of its longest side
  /// in steps of 1.41, each only when it has less than 3/4 of the triangles of the one before. Keeps a copy in memory
  /// until then.
  static Result<LodMesh> growing(PackedMesh mesh);

  LodMesh();
  LodMesh(LodMesh&&) noexcept;
  LodMesh& operator=(LodMesh&&) noexcept;
  ~LodMesh();  ///< a thread that still works is stopped and waited for, a level's time at most

  /// Takes in what is ready, a few megabytes a call. True when level 0 is another one than before. kTryAgain without
  /// memory.
  Result<bool> update();
  /// Gives all levels, also those that come later, figures that their vertices carry; replaces others. kTryAgain.
  Result<void> carry(std::shared_ptr<const SurfaceFields> fields);
  /// What was measured of it; null: nothing yet.
  const SurfaceFields* fields() const noexcept { return fields_.get(); }
  /// Whether level 0 is the mesh as it is.
  bool has_exact() const noexcept { return !levels_.empty() && levels_.front().cell_mm == 0.0; }
  /// Whether all levels are there.
  bool complete() const noexcept { return growth_ == nullptr; }

  int levels() const noexcept { return static_cast<int>(levels_.size()); }
  const GpuMesh& level(int i) const { return levels_[static_cast<std::size_t>(i)].mesh; }  ///< 0 the finest
  double cell_mm(int i) const { return levels_[static_cast<std::size_t>(i)].cell_mm; }     ///< 0: as the mesh is
  std::int64_t triangles(int i) const { return levels_[static_cast<std::size_t>(i)].triangles; }
  /// The coarsest level whose grid is at most `cell_mm`; 0 for 0.
  int level_for(double cell_mm) const noexcept;

  const Box& box_mm() const noexcept { return levels_.front().mesh.box_mm(); }
  /// Box of the partitions whose bit is set; a box of size 0 when they hold no triangle.
  Box box_of(std::uint8_t partitions) const;
  /// Whether any of these has triangles.
  bool has_any(std::uint8_t partitions) const noexcept { return (has_triangles_ & partitions) != 0; }

 private:
  struct Level {
    GpuMesh mesh;
    double cell_mm = 0.0;
    std::int64_t triangles = 0;
    bool quick = false;  ///< until a better one is made
  };
  class Growth;
  struct Coming;
  Result<void> add(const PackedMesh& level, double cell_mm);
  Result<void> insert(GpuMesh gpu, double cell_mm, std::size_t triangles);
  void describe(const PackedMesh& mesh);

  std::vector<Level> levels_;  ///< finest first
  std::array<Box, kMaxPartitions> partition_box_mm_{};
  std::uint8_t has_triangles_ = 0;  ///< bit p: partition p
  std::shared_ptr<const SurfaceFields> fields_;
  std::unique_ptr<Growth> growth_;  ///< while levels are missing
  std::unique_ptr<Coming> coming_;  ///< not yet among them
};

/// Measures what `needs` names and the levels of detail do not carry yet, `mesh` being what they were made from. Errors
/// of measure_fields() and LodMesh::carry().
Result<void> carry_fields(LodMesh& levels, const TriMesh& mesh, const FieldNeeds& needs, Progress& progress);

}  // namespace dubsar
