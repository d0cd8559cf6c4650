#pragma once
// One camera, as maths: what a sink asks the renderer for. No GL here.

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
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

/// How the pictures of many views are put onto the panel, as the maker's player has it (Looking Glass Bridge).
struct ViewFocus {
  double focus =
      0.0;  ///< widths of the picture by which the outermost views are moved against the middle one, -0.5..0.5
  double zoom = 1.0;  ///< about the middle, 0.1..10
  friend bool operator==(const ViewFocus&, const ViewFocus&) = default;
};

/// Where the pixel (u, v) of the picture of view `index` of `count` comes from, 0..1, v either way: (u - 1/2) / zoom +
/// 1/2 + (2 g - 1) focus with g = (index + 1/2) / count. A focus above 0 moves what stood on the panel's plane towards
/// the viewer.
glm::dvec2 focus_source(const ViewFocus& focus, int index, int count, const glm::dvec2& uv) noexcept;

/// The same for a camera: its picture is what focus_source() would make of the picture of `view`, drawn anew.
View focused_view(View view, const ViewFocus& focus, int index, int count);

/// The part of a view that covers pixels [x, x + w) x [y, y + h) (y from the bottom) of a full picture of
/// full_w x full_h pixels: for pictures larger than a frame buffer. Pixel centres stay where they were.
View crop_view(const View& view, int x, int y, int w, int h, int full_w, int full_h);

}  // namespace dubsar
