#include "display/render/passes/peel_pass.h"

#include <algorithm>
#include <array>

#include "display/render/passes/instalments.h"

namespace dubsar {

Result<PeelPass> PeelPass::create() {
  PeelPass out;
  DUBSAR_ASSIGN(out.copy_, make_program("fullscreen.vert", "samples.frag"));
  out.no_vertices_ = make_vertex_array();
  GLuint name = 0;
  glCreateQueries(GL_ANY_SAMPLES_PASSED, 1, &name);
  out.any_ = GlName<Query>(name);
  return out;
}

Result<void> PeelPass::use_size(int width, int height) {
  if (width_ == width && height_ == height) return {};
  const auto texture = [&](GLenum format) {
    GlTexture out = make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(out, 1, format, width, height);
    return out;
  };
  opaque_ = texture(GL_DEPTH_COMPONENT32F);
  layer_color_ = texture(GL_RGBA16F);
  sum_ = texture(GL_RGBA16F);
  for (std::size_t i = 0; i < 2; ++i) {
    depth_[i] = texture(GL_DEPTH_COMPONENT32F);
    layer_[i] = make_framebuffer();
    glNamedFramebufferTexture(layer_[i], GL_COLOR_ATTACHMENT0, layer_color_, 0);
    glNamedFramebufferTexture(layer_[i], GL_DEPTH_ATTACHMENT, depth_[i], 0);
  }
  sum_framebuffer_ = make_framebuffer();
  glNamedFramebufferTexture(sum_framebuffer_, GL_COLOR_ATTACHMENT0, sum_, 0);
  width_ = width;
  height_ = height;
  return check_gl("making the layers of transparent surfaces");
}

void PeelPass::lay(GLuint into, GLuint texture, GLenum above, GLenum below) {
  glBindFramebuffer(GL_FRAMEBUFFER, into);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(above, below);
  glUseProgram(copy_);
  glBindTextureUnit(0, texture);
  glBindVertexArray(no_vertices_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
}

/// Whether there was something in it, as far as it is drawn.
Result<bool> PeelPass::draw_layer(MeshPass& meshes, const SceneView& scene, const PassViews& target,
                                  const ShadowMap* shadows, std::size_t layer, Instalments* pieces) {
  const std::size_t now = layer % 2;
  const auto clear = [&]() -> Result<void> {
    const std::array<float, 4> nothing{};
    const float far_depth = 1.0f;
    glClearNamedFramebufferfv(layer_[now], GL_COLOR, 0, nothing.data());
    glClearNamedFramebufferfv(layer_[now], GL_DEPTH, 0, &far_depth);
    seen_[layer] = false;
    return {};
  };
  DUBSAR_TRY(once(pieces, clear));
  glBindFramebuffer(GL_FRAMEBUFFER, layer_[now]);
  glBeginQuery(GL_ANY_SAMPLES_PASSED, any_);
  for (const DrawItem& item : scene.items)
    if (const auto* mesh = std::get_if<MeshItem>(&item))
      DUBSAR_TRY(meshes.draw(*mesh, scene, target, {shadows, opaque_, depth_[1 - now], pieces}));
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  GLuint any = 0;
  glGetQueryObjectuiv(any_, GL_QUERY_RESULT, &any);
  return seen_[layer] = seen_[layer] || any != 0;
}

Result<void> PeelPass::draw(MeshPass& meshes, const SceneView& scene, const PassViews& target, const ShadowMap* shadows,
                            GLuint framebuffer, GLuint opaque_depth, int depth_layer, Instalments* pieces) {
  DUBSAR_TRY(use_size(target.width_px, target.height_px));
  const bool coded = glIsEnabled(GL_FRAMEBUFFER_SRGB) == GL_TRUE;
  glDisable(GL_FRAMEBUFFER_SRGB);
  const auto begin = [&]() -> Result<void> {
    const std::array<float, 4> nothing{};
    const float near_depth = -1.0f;
    glCopyImageSubData(opaque_depth, depth_layer < 0 ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY, 0, 0, 0,
                       std::max(depth_layer, 0), opaque_, GL_TEXTURE_2D, 0, 0, 0, 0, width_, height_, 1);
    glClearNamedFramebufferfv(sum_framebuffer_, GL_COLOR, 0, nothing.data());
    glClearNamedFramebufferfv(layer_[1], GL_DEPTH, 0, &near_depth);  // what was peeled before the first layer
    return {};
  };
  DUBSAR_TRY(once(pieces, begin));
  const auto paused = [&] { return pieces != nullptr && pieces->paused(); };
  for (std::size_t layer = 0; layer < kMostLayers && !paused(); ++layer) {
    DUBSAR_ASSIGN(const bool seen, draw_layer(meshes, scene, target, shadows, layer, pieces));
    if (paused() || !seen) break;
    DUBSAR_TRY(once(pieces, [&]() -> Result<void> {
      lay(sum_framebuffer_, layer_color_, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
      return {};
    }));
  }
  if (coded) glEnable(GL_FRAMEBUFFER_SRGB);
  DUBSAR_TRY(once(pieces, [&]() -> Result<void> {
    lay(framebuffer, sum_, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    return {};
  }));
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  return check_gl("drawing transparent surfaces");
}

}  // namespace dubsar
