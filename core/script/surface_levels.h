#pragma once
// A surface as coarse as what is looked for on it allows.

#include <memory>
#include <vector>

#include "core/script/tangent_patch.h"

namespace dubsar {

/// A surface of no more is coarse: as the photographed ones, whose heads are two or three edges wide. What is found
/// then depends on how it lies.
inline constexpr std::size_t kCoarseTriangles = 60000;

class SurfaceLevels {
 public:
  /// Keeps no reference. Cost: some 50 ns a triangle.
  explicit SurfaceLevels(const TriMesh& mesh) { levels_.push_back(std::make_unique<PatchCells>(mesh)); }
  explicit SurfaceLevels(PatchCells cells) { levels_.push_back(std::make_unique<PatchCells>(std::move(cells))); }

  /// The surface itself: of what is measured.
  const PatchCells& fine() const noexcept { return *levels_.front(); }
  /// For patches of heads of this width: the surface itself, or at least 12 edges a width where it has 24 and more.
  /// Levels are made when they are asked for first; one thread. Valid as long as the levels are.
  const PatchCells& for_width(double width_mm);

 private:
  std::vector<std::unique_ptr<PatchCells>> levels_;  ///< each with edges twice as long
};

/// Vertices in each cube of this size become their mean (Rossignac, Borrel: Multi-resolution 3D approximations for
/// rendering complex scenes, 1993). Cost: some 100 ns a vertex.
PatchCells clustered(const PatchCells& cells, double cube_mm);

}  // namespace dubsar
