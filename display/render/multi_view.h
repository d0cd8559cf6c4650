#pragma once
// Many views of a scene, quickly: coarse ones while things move, exact ones when they rest.

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
  /// Moving: more is merged, up to 12 pixels, until a picture takes no longer than this. Waits for the GPU, to know.
  /// The first picture is as coarse as that. 0: whatever it takes.
  double budget_ms = 0.0;
};

/// One GL thread.
class MultiView {
 public:
  static Result<MultiView> create(const MultiViewOptions& options = {});

  /// All layers of `target`, for views that changed: one sample a pixel, level of detail by the views' size, all key
  /// views in one draw, the others reprojected. `pictures`: so many of them share the budget.
  Result<void> draw_moving(const SceneView& scene, std::span<const View> views, ViewArray& target, int pictures = 1);

  /// Makes up to `most` layers exact, from the middle of the views outwards, as Renderer::render() does. Returns how
  /// many are still coarse. Views, scene and target must be those of the last draw_moving().
  Result<int> refine(const SceneView& scene, std::span<const View> views, int samples, ViewArray& target, int most);

  /// The same in instalments, each until `end` of the steady clock or a little longer: the window answers in between.
  /// A view whose exact picture is not whole stays coarse.
  Result<int> refine_until(TimestampNs end, const SceneView& scene, std::span<const View> views, int samples,
                           ViewArray& target);

  /// The first `views` layers are coarse, as after draw_moving(): what refine() does next is of other views or scenes.
  void begin_refining(int views);

  /// All layers of `target` exact, as Renderer::render().
  Result<void> draw_exact(const SceneView& scene, std::span<const View> views, int samples, ViewArray& target);

 private:
  void took(double ms);
  int keys_for(std::span<const View> views, const ViewArray& target, const Box& box) const;

  MultiViewOptions options_;
  Renderer renderer_;
  Reprojector reprojector_;
  double coarse_px_ = 0.0;  ///< what draw_moving() merges now
  int coarse_ = 0;          ///< views that refine() has to do yet
};

/// `keys` of `count` views (fewer: all), from the first to the last, evenly.
std::vector<int> key_views(int count, int keys);

}  // namespace dubsar
