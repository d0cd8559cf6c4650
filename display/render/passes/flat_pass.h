#pragma once
// The part of the renderer that draws what has no thickness: lines.

#include <span>

#include "core/base/result.h"
#include "display/render/context/gl_objects.h"
#include "display/render/passes/mesh_pass.h"
#include "display/render/scene.h"

namespace dubsar {

class FlatPass {
 public:
  /// `layered` as MeshPass::layered().
  static Result<FlatPass> create(bool layered);

  /// `pixel` is how many samples of the target a pixel of the picture has on a side.
  Result<void> draw(const LinesItem& item, const PassViews& target, double pixel);

 private:
  void bind_views(const PassViews& target);

  GlProgram lines_, lines_layered_;
  GlVertexArray no_vertices_;
  GlBuffer views_, points_;
};

}  // namespace dubsar
