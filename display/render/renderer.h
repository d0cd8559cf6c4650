#pragma once
// Draws a scene for any number of views into the layers of a view array.

#include <span>

#include "core/base/result.h"
#include "display/optics/view.h"
#include "display/render/passes/flat_pass.h"
#include "display/render/passes/instalments.h"
#include "display/render/passes/label_pass.h"
#include "display/render/passes/mesh_pass.h"
#include "display/render/passes/peel_pass.h"
#include "display/render/passes/shadow_map.h"
#include "display/render/scene.h"
#include "display/render/view_array.h"

namespace dubsar {

class Renderer {
 public:
  /// Compiles the shaders. Everything happens in the thread of the current GL 4.5 context, and all objects go before
  /// the context does.
  /// `layered` false: as on a driver that cannot choose layers in vertex shaders.
  static Result<Renderer> create(bool layered = true);

  /// Layer first_layer + i of `target` gets views[i] of the scene. `factor` x `factor` samples a pixel (1..8), averaged
  /// in linear light. Pixels: the colour of a vertex is interpolated, light is computed per sample. Meshes with all
  /// their triangles. kUsage as check_scene().
  Result<void> render(const SceneView& scene, std::span<const View> views, int factor, ViewArray& target,
                      int first_layer = 0);

  /// As render() of one view, in instalments: true when the layer has it, until then the layer stays as it is. Scene,
  /// view, factor and target must be the same in each; restart_pieces() before the first one of another picture. Other
  /// pictures may be drawn in between.
  Result<bool> render_some(const SceneView& scene, const View& view, int factor, ViewArray& target, int layer,
                           TimestampNs end);
  void restart_pieces() noexcept;

  /// Layer layers[i] of `target` gets views[i], with one sample a pixel, in one instanced draw for each item; where the
  /// driver cannot choose layers in vertex shaders (ARB_shader_viewport_layer_array), and for transparent parts, one
  /// view after the other. All other layers become background. Transparent backgrounds are drawn opaque. Meshes in the
  /// level of detail that merges what is smaller than `coarse_px` pixels. Quick, for things that move. kUsage as
  /// check_scene().
  Result<void> render_layers(const SceneView& scene, std::span<const View> views, std::span<const int> layers,
                             ViewArray& target, double coarse_px = 0.0);
  /// Depth buffers of the last render_layers(), the same layers as its target (GL_TEXTURE_2D_ARRAY); 1 is background.
  GLuint layer_depths() const noexcept { return layer_depth_.depth; }

 private:
  struct Scratch {  ///< samples of one view: linear light, premultiplied
    int width = 0, height = 0;
    GlTexture color, depth;
    GlFramebuffer framebuffer;
  };
  struct LayerDepth {
    int width = 0, height = 0, layers = 0;
    GlTexture depth;
    GlFramebuffer framebuffer;
  };
  /// What one of the exact pictures is drawn into.
  struct Exact {
    Scratch samples;
    ShadowMap shadows;
  };
  static Result<void> use_scratch(Scratch& scratch, int width, int height);
  Result<void> draw_exact(const SceneView& scene, const View& view, int factor, const ViewArray& target, Exact& into,
                          bool in_pieces);
  void resolve(const Scratch& scratch, int factor, ViewArray& target, int layer);
  Result<void> use_layer_depth(const ViewArray& target);
  struct Into {  ///< for transparent parts
    GLuint framebuffer = 0, depth = 0;
    int depth_layer = -1;
  };
  static Result<const ShadowMap*> cast_shadows(ShadowMap& map, const SceneView& scene, std::span<const View> views,
                                               int size, double coarse_px, int width_px, Instalments* pieces = nullptr);
  Result<void> judge_labels(const SceneView& scene, int width, int height);
  Result<void> draw_items(const SceneView& scene, const PassViews& target, const ShadowMap* shadows, double pixel,
                          const Into& into, Instalments* pieces = nullptr);

  MeshPass meshes_;
  FlatPass flat_;
  LabelPass labels_;
  PeelPass peel_, peel_in_pieces_;
  ShadowMap quick_shadows_;
  GlProgram resolve_program_;
  GlVertexArray no_vertices_;
  GlFramebuffer layer_;
  Exact whole_, in_pieces_;
  Instalments shadow_pieces_, pieces_;
  Scratch judged_;
  LayerDepth layer_depth_;
};

}  // namespace dubsar
