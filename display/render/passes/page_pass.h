#pragma once
// A page of text that stands in the world, drawn over finished views: what somebody with a headset reads.

#include <span>

#include "core/base/result.h"
#include "display/optics/view.h"
#include "display/render/context/gl_objects.h"
#include "display/render/view_array.h"

namespace dubsar {

/// A rectangle of the world, mm: corner + [0, 1] right + [0, 1] up.
struct PagePlace {
  glm::dvec3 corner{0.0}, right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0};
};

class PagePass {
 public:
  static Result<PagePass> create();

  /// Layer 0 of `page` at its place over every layer of `target`, in front of all that is there. Its colours are
  /// sRGB-coded and multiplied by their alpha, as what is blended onto nothing comes out.
  Result<void> draw(const ViewArray& page, const PagePlace& place, std::span<const View> views, ViewArray& target);

 private:
  GlProgram program_;
  GlVertexArray no_vertices_;
  GlFramebuffer layer_;
};

}  // namespace dubsar
