#pragma once
// The part of the renderer that draws lines of text.

#include <glm/mat4x4.hpp>
#include <span>

#include "core/base/result.h"
#include "display/render/context/gl_objects.h"
#include "display/render/passes/flat_views.h"
#include "display/render/passes/mesh_pass.h"
#include "display/render/scene.h"

namespace dubsar {

class LabelPass {
 public:
  /// `layered` as MeshPass::layered().
  static Result<LabelPass> create(bool layered);
  /// The labels of `items`, over what was drawn before. `pixel` is how many samples of the target a pixel of the
  /// picture has on a side. `judged`: all views go by what judge() saw of the same items.
  Result<void> draw(std::span<const DrawItem> items, const PassViews& target, double pixel, bool judged = false);
  /// Looks which labels are seen in one view without layers, whose depths are in the current frame buffer.
  Result<void> judge(std::span<const DrawItem> items, const PassViews& target, double pixel);

 private:
  struct Programs {
    GlProgram letters, places;
  };
  void use_sheet(const LabelFont& font);
  void see_places(std::span<const LabelItem* const> labels, const PassViews& target, double side);
  void draw_letters(const LabelItem& item, const PassViews& target, double pixel);
  void begin(const PassViews& target);

  Programs alone_, layered_;
  GlVertexArray no_vertices_;
  GlBuffer views_, letters_, places_, seen_;
  GlTexture sheet_;
  const LabelFont* font_ = nullptr;  // whose sheet it is
  std::uint64_t version_ = 0;
  glm::mat4 judge_clip_{1.0f};  // of the view that judged, and the square it looked at
  glm::vec4 judge_measures_{0.0f};
};

}  // namespace dubsar
