#pragma once
// Many views of one mesh, quickly: coarse ones while things move, exact ones when they rest.

#include <span>
#include <vector>

#include "core/base/result.h"
#include "display/render/renderer.h"
#include "display/render/reproject.h"

namespace dubsar {

struct MultiViewOptions {
  double cell_px = 1.5;  ///< moving: details smaller than this are merged; 0: all triangles
  /// Moving: of more views in one row, about this many are drawn and the others reprojected from them
  /// (display/render/reproject.h); more where the object would shift by more than 16 pixels from one drawn view to the
  /// next. 0: all are drawn.
  int key_views = 8;
};

/// A mesh in several levels of detail in graphics memory. One GL thread.
class MultiView {
 public:
  /// Levels of the mesh: as it is, then by grids of 1/1024 to 1/64 of its longest side in steps of 1.41, each only when
  /// it has less than 3/4 of the triangles of the one before. Takes the triangles' order from `mesh`. Errors of
  /// GpuMesh::upload.
  static Result<MultiView> create(PackedMesh mesh, const MultiViewOptions& options = {});

  /// All layers of `target`, for views that changed: one sample a pixel, level of detail by the views' size, all key
  /// views in one draw, the others reprojected. world of `views` is the mesh's.
  Result<void> draw_moving(const Shading& shading, std::span<const View> views, ViewArray& target);

  /// Makes up to `most` layers exact, from the middle of the views outwards, as Renderer::render() with all triangles.
  /// Returns how many are still coarse. Views, shading and target must be those of the last draw_moving().
  Result<int> refine(const Shading& shading, std::span<const View> views, int samples, ViewArray& target, int most);

  /// All layers of `target` exact, as Renderer::render() with all triangles.
  Result<void> draw_exact(const Shading& shading, std::span<const View> views, int samples, ViewArray& target);

  int levels() const noexcept { return static_cast<int>(levels_.size()); }
  /// Triangles of a level, 0 the finest.
  std::int64_t triangles(int level) const { return levels_[static_cast<std::size_t>(level)].triangles; }
  /// The level that draw_moving() uses for a view that shows `mm_per_pixel` of the mesh.
  int level_for(double mm_per_pixel) const noexcept;

 private:
  struct Level {
    GpuMesh mesh;
    double cell_mm = 0.0;
    std::int64_t triangles = 0;
  };
  int keys_for(std::span<const View> views, const ViewArray& target, const Box& box) const;

  MultiViewOptions options_;
  Renderer renderer_;
  Reprojector reprojector_;
  std::vector<Level> levels_;  ///< finest first
  int coarse_ = 0;             ///< views that refine() has to do yet
};

/// How much of the world one pixel of the view shows at `point`, in mm.
double mm_per_pixel_at(const View& view, const glm::dvec3& point, int width_px);

/// `keys` of `count` views (fewer: all), from the first to the last, evenly.
std::vector<int> key_views(int count, int keys);

}  // namespace dubsar
