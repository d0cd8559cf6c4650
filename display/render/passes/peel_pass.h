#pragma once
// Transparent parts in the right order, whatever the order of drawing: layer by layer from the front (depth peeling,
// Everitt 2001), each laid under those before it.

#include <array>

#include "core/base/result.h"
#include "display/render/context/gl_objects.h"
#include "display/render/passes/mesh_pass.h"

namespace dubsar {

class PeelPass {
 public:
  static Result<PeelPass> create();

  /// Draws the transparent parts of the scene over one view: `color` in linear light, premultiplied, as the current
  /// blending of `framebuffer` wants it. `opaque_depth` (32-bit float; a layer of an array where `depth_layer` is not
  /// below 0) is what was drawn. At most kMostLayers; what lies deeper is left out. Cost: a draw of all transparent
  /// parts for each layer that is seen. `pieces`: as much of it as there is time for; until they are not paused nothing
  /// else may be drawn by this pass.
  Result<void> draw(MeshPass& meshes, const SceneView& scene, const PassViews& target, const ShadowMap* shadows,
                    GLuint framebuffer, GLuint opaque_depth, int depth_layer, Instalments* pieces = nullptr);

  static constexpr int kMostLayers = 32;

 private:
  struct Query {
    static void destroy(GLuint name) { glDeleteQueries(1, &name); }
  };
  Result<void> use_size(int width, int height);
  Result<bool> draw_layer(MeshPass& meshes, const SceneView& scene, const PassViews& target, const ShadowMap* shadows,
                          std::size_t layer, Instalments* pieces);
  void lay(GLuint into, GLuint texture, GLenum above, GLenum below);

  GlProgram copy_;
  GlVertexArray no_vertices_;
  GlName<Query> any_;
  int width_ = 0, height_ = 0;
  GlTexture opaque_, layer_color_, sum_;
  std::array<GlTexture, 2> depth_;
  std::array<GlFramebuffer, 2> layer_;
  GlFramebuffer sum_framebuffer_;
  std::array<bool, kMostLayers> seen_{};  ///< layers of the present picture in which there is something
};

}  // namespace dubsar
