#pragma once
// One camera, as maths: what a sink asks the renderer for. No GL here.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace dubsar {

/// Frames: world in mm (model frame of the scan, or screen frame of a panel); view: eye at the origin, +X right, +Y up,
/// looking along -Z, in mm; clip as in OpenGL (z from -w to w). Both matrices are for column vectors.
struct View {
  glm::dmat4 view_from_world{1.0};
  glm::dmat4 clip_from_view{1.0};

  glm::dmat4 clip_from_world() const { return clip_from_view * view_from_world; }
  /// True for parallel projection: the eye is infinitely far away.
  bool orthographic() const { return clip_from_view[2][3] == 0.0; }
};

/// The part of a view that covers pixels [x, x + w) x [y, y + h) (y from the bottom) of a full picture of
/// full_w x full_h pixels: for pictures larger than a frame buffer. Pixel centres stay where they were.
View crop_view(const View& view, int x, int y, int w, int h, int full_w, int full_h);

}  // namespace dubsar
