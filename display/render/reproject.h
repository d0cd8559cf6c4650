#pragma once
// Views between drawn views, from their colours and depths: for pictures that move. Cameras in one row see a
// point at places of one pixel row, and its shift between two of them is linear in what the depth buffer
// holds.

#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "display/optics/view.h"
#include "display/render/camera.h"
#include "display/render/context/gl_objects.h"
#include "display/render/view_array.h"

namespace dubsar {

/// Pixels to the right that a point moves from one view to another: slope * depth + offset, depth 0..1 as in
/// the depth buffer of the first.
struct RowShift {
  double slope = 0.0, offset = 0.0;
  double at(double depth) const noexcept { return slope * depth + offset; }
};

/// Nothing when the views differ by more than a shift along rows (1/20 of a pixel anywhere).
std::optional<RowShift> row_shift(const View& from, const View& to, int width_px, int height_px);

/// Depths, 0..1 as in the depth buffer, between which the view sees the box.
struct DepthRange {
  double nearest = 0.0, farthest = 1.0;
};
DepthRange depth_range(const View& view, const Box& box);

class Reprojector {
 public:
  static Result<Reprojector> create();

  /// Fills each layer of `target` that is not in `drawn` (ascending, at least one) from the drawn layers on
  /// both of its sides. views[i] belongs to layer i; each pair of neighbours must have a row_shift().
  /// `depths` are the drawn layers' depth buffers, `box` all that was drawn. Holes that no drawn view has
  /// seen show what is behind them. Cost: about as many texture reads a pixel as the object's shift between
  /// neighbouring drawn views has pixels, plus 6.
  Result<void> fill(ViewArray& target, GLuint depths, std::span<const View> views, std::span<const int> drawn,
                    const Box& box);

 private:
  GlProgram program_;
  GlVertexArray no_vertices_;
  GlFramebuffer layer_;
};

}  // namespace dubsar
