#include "display/render/renderer.h"

#include <algorithm>
#include <glm/vec4.hpp>

namespace dubsar {
namespace {

constexpr GLint kFactorLocation = 0;    // shaders/resolve.frag
constexpr int kJudgePx = 1024;          // of the longer side of a picture that tells which labels are seen
constexpr double kJudgeCoarsePx = 4.0;  // details it may merge
constexpr int kShadowTexels = 4096, kQuickShadowTexels = 1024;
constexpr double kTexelsADetail = 4;  // of the map, for what a coarse picture merges

glm::vec4 opaque_background(const SceneView& scene) { return glm::vec4(linear_color(scene.background.color), 1.0f); }

bool has_labels(const SceneView& scene) {
  return std::any_of(scene.items.begin(), scene.items.end(),
                     [](const DrawItem& item) { return std::holds_alternative<LabelItem>(item); });
}

/// Of the map of a moving picture: half, where its triangles are so large that more would show nothing.
int quick_shadow_texels(const ViewArray& target, double coarse_px) {
  const bool few = kTexelsADetail * std::max(target.width(), target.height()) <= 0.5 * kQuickShadowTexels * coarse_px;
  return few ? kQuickShadowTexels / 2 : kQuickShadowTexels;
}

/// `coded`: the shaders' linear light becomes sRGB bytes.
void begin_drawing(GLuint framebuffer, int width, int height, bool coded) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  (coded ? glEnable : glDisable)(GL_FRAMEBUFFER_SRGB);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
}

void clear_target(GLuint framebuffer, const glm::vec4& background) {
  const float far_depth = 1.0f;
  glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, &background[0]);
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &far_depth);
}

}  // namespace

Result<Renderer> Renderer::create(bool layered) {
  if (glGetString(GL_VERSION) == nullptr)
    return fail(ErrorKind::kUnavailable, "render: no OpenGL context is current, expected GL 4.5");
  Renderer out;
  DUBSAR_ASSIGN(out.meshes_, MeshPass::create(layered));
  DUBSAR_ASSIGN(out.flat_, FlatPass::create(out.meshes_.layered()));
  DUBSAR_ASSIGN(out.labels_, LabelPass::create(out.meshes_.layered()));
  for (PeelPass* const peel : {&out.peel_, &out.peel_in_pieces_}) {
    DUBSAR_ASSIGN(*peel, PeelPass::create());
  }
  for (ShadowMap* const map : {&out.quick_shadows_, &out.whole_.shadows, &out.in_pieces_.shadows}) {
    DUBSAR_ASSIGN(*map, ShadowMap::create());
  }
  DUBSAR_ASSIGN(out.resolve_program_, make_program("fullscreen.vert", "resolve.frag"));
  out.no_vertices_ = make_vertex_array();
  out.layer_ = make_framebuffer();
  DUBSAR_TRY(check_gl("making the renderer"));
  return out;
}

Result<void> Renderer::use_scratch(Scratch& scratch, int width, int height) {
  if (scratch.width == width && scratch.height == height) return {};
  GLint max_side = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_side);
  if (width > max_side || height > max_side)
    return fail(ErrorKind::kUsage, "render: {} x {} samples are needed, this context has at most {} on a side", width,
                height, max_side);
  Scratch made;
  made.width = width;
  made.height = height;
  made.color = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(made.color, 1, GL_RGBA16F, width, height);
  made.depth = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(made.depth, 1, GL_DEPTH_COMPONENT32F, width, height);
  made.framebuffer = make_framebuffer();
  glNamedFramebufferTexture(made.framebuffer, GL_COLOR_ATTACHMENT0, made.color, 0);
  glNamedFramebufferTexture(made.framebuffer, GL_DEPTH_ATTACHMENT, made.depth, 0);
  DUBSAR_TRY(check_gl("making the frame buffer"));
  if (glCheckNamedFramebufferStatus(made.framebuffer, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return fail(ErrorKind::kUnavailable, "render: the driver refuses a frame buffer of half floats");
  scratch = std::move(made);
  return {};
}

Result<void> Renderer::use_layer_depth(const ViewArray& target) {
  if (layer_depth_.width == target.width() && layer_depth_.height == target.height() &&
      layer_depth_.layers == target.layers())
    return {};
  layer_depth_ = {};  // before the new one: both together may not fit
  LayerDepth made;
  made.width = target.width();
  made.height = target.height();
  made.layers = target.layers();
  made.depth = make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(made.depth, 1, GL_DEPTH_COMPONENT32F, made.width, made.height, made.layers);
  made.framebuffer = make_framebuffer();
  DUBSAR_TRY(check_gl("making the layers' depth buffer"));
  layer_depth_ = std::move(made);
  return {};
}

Result<const ShadowMap*> Renderer::cast_shadows(ShadowMap& map, const SceneView& scene, std::span<const View> views,
                                                int size, double coarse_px, int width_px, Instalments* pieces) {
  if (!casts_shadows(scene)) return nullptr;
  DUBSAR_TRY(map.draw(scene, views, size, coarse_px, width_px, pieces));
  return &map;
}

Result<void> Renderer::draw_items(const SceneView& scene, const PassViews& target, const ShadowMap* shadows,
                                  double pixel, const Into& into, Instalments* pieces) {
  for (const DrawItem& item : scene.items)
    if (const auto* mesh = std::get_if<MeshItem>(&item))
      DUBSAR_TRY(meshes_.draw(*mesh, scene, target, {.shadows = shadows, .pieces = pieces}));
  const auto flat = [&]() -> Result<void> {
    for (const DrawItem& item : scene.items)
      if (const auto* lines = std::get_if<LinesItem>(&item)) DUBSAR_TRY(flat_.draw(*lines, target, pixel));
    return {};
  };
  DUBSAR_TRY(once(pieces, flat));
  if (has_transparency(scene)) {
    PeelPass& peel = pieces != nullptr ? peel_in_pieces_ : peel_;
    DUBSAR_TRY(peel.draw(meshes_, scene, target, shadows, into.framebuffer, into.depth, into.depth_layer, pieces));
  }
  return once(pieces, [&]() -> Result<void> {
    GLint into_framebuffer = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &into_framebuffer);
    const bool judged = scene.judge != nullptr && has_labels(scene);
    if (judged) {
      DUBSAR_TRY(judge_labels(scene, target.width_px, target.height_px));
      glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(into_framebuffer));
      glViewport(0, 0, target.width_px, target.height_px);
    }
    return labels_.draw(scene.items, target, pixel, judged);
  });
}

/// With few triangles and no colours: labels stand before what is rough around their places.
Result<void> Renderer::judge_labels(const SceneView& scene, int width, int height) {
  const double shrunk = std::min(1.0, static_cast<double>(kJudgePx) / std::max(width, height));
  const int w = std::max(1, static_cast<int>(width * shrunk)), h = std::max(1, static_cast<int>(height * shrunk));
  DUBSAR_TRY(use_scratch(judged_, w, h));
  glBindFramebuffer(GL_FRAMEBUFFER, judged_.framebuffer);
  glViewport(0, 0, w, h);
  clear_target(judged_.framebuffer, glm::vec4(0.0f));
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  const PassViews target{std::span(scene.judge, 1), {}, w, h, kJudgeCoarsePx};
  for (const DrawItem& item : scene.items)
    if (const auto* mesh = std::get_if<MeshItem>(&item)) DUBSAR_TRY(meshes_.draw(*mesh, scene, target, {}));
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  return labels_.judge(scene.items, target, 1.0);
}

Result<void> Renderer::render_layers(const SceneView& scene, std::span<const View> views, std::span<const int> layers,
                                     ViewArray& target, double coarse_px) {
  DUBSAR_CHECK(views.size() == layers.size());
  for (const int layer : layers) DUBSAR_CHECK(layer >= 0 && layer < target.layers());
  if (views.empty()) return {};
  DUBSAR_TRY(check_scene(scene));
  DUBSAR_TRY(use_layer_depth(target));
  const bool together =
      meshes_.layered() && !has_transparency(scene) && (!casts_shadows(scene) || same_direction(views));
  const int shadow_texels = quick_shadow_texels(target, coarse_px);
  const ShadowMap* shadows = nullptr;
  if (together) {
    DUBSAR_ASSIGN(shadows, cast_shadows(quick_shadows_, scene, views, shadow_texels, coarse_px, target.width()));
  }
  const GLuint framebuffer = layer_depth_.framebuffer;
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, target.linear(), 0);
  glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, layer_depth_.depth, 0);
  begin_drawing(framebuffer, target.width(), target.height(), true);
  clear_target(framebuffer, opaque_background(scene));
  if (together)
    DUBSAR_TRY(draw_items(scene, {views, layers, target.width(), target.height(), coarse_px}, shadows, 1.0, {}));
  for (std::size_t i = 0; i < views.size() && !together; ++i) {
    const auto one = views.subspan(i, 1);
    DUBSAR_ASSIGN(shadows, cast_shadows(quick_shadows_, scene, one, shadow_texels, coarse_px, target.width()));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, target.width(), target.height());
    glNamedFramebufferTextureLayer(framebuffer, GL_COLOR_ATTACHMENT0, target.linear(), 0, layers[i]);
    glNamedFramebufferTextureLayer(framebuffer, GL_DEPTH_ATTACHMENT, layer_depth_.depth, 0, layers[i]);
    DUBSAR_TRY(draw_items(scene, {one, {}, target.width(), target.height(), coarse_px}, shadows, 1.0,
                          {framebuffer, layer_depth_.depth, layers[i]}));
  }
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, 0, 0);  // the target may go before us
  return check_gl("drawing layers");
}

Result<void> Renderer::render(const SceneView& scene, std::span<const View> views, int factor, ViewArray& target,
                              int first_layer) {
  if (factor < 1 || factor > 8)
    return fail(ErrorKind::kUsage, "render: {0} x {0} samples a pixel asked for, expected 1 x 1 to 8 x 8", factor);
  DUBSAR_CHECK(first_layer >= 0 && first_layer + static_cast<std::int64_t>(views.size()) <= target.layers());
  if (views.empty()) return {};
  DUBSAR_TRY(check_scene(scene));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const int layer = first_layer + static_cast<int>(i);
    DUBSAR_TRY(draw_exact(scene, views[i], factor, target, whole_, false));
    resolve(whole_.samples, factor, target, layer);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return check_gl("drawing");
}

Result<bool> Renderer::render_some(const SceneView& scene, const View& view, int factor, ViewArray& target, int layer,
                                   TimestampNs end) {
  DUBSAR_CHECK(factor >= 1 && factor <= 8 && layer >= 0 && layer < target.layers());
  DUBSAR_TRY(check_scene(scene));
  shadow_pieces_.begin(end);
  pieces_.begin(end);
  DUBSAR_TRY(draw_exact(scene, view, factor, target, in_pieces_, true));
  const bool done = !shadow_pieces_.paused() && !pieces_.paused();
  if (done) {
    resolve(in_pieces_.samples, factor, target, layer);
    restart_pieces();
  } else {
    pieces_.finish();
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  DUBSAR_TRY(check_gl("drawing a piece"));
  return done;
}

void Renderer::restart_pieces() noexcept {
  shadow_pieces_.restart();
  pieces_.restart();
}

Result<void> Renderer::draw_exact(const SceneView& scene, const View& view, int factor, const ViewArray& target,
                                  Exact& into, bool in_pieces) {
  Scratch& samples = into.samples;
  DUBSAR_TRY(use_scratch(samples, target.width() * factor, target.height() * factor));
  const std::span<const View> one(&view, 1);
  DUBSAR_ASSIGN(const ShadowMap* const shadows, cast_shadows(into.shadows, scene, one, kShadowTexels, 0.0,
                                                             target.width(), in_pieces ? &shadow_pieces_ : nullptr));
  if (in_pieces && shadow_pieces_.paused()) return {};
  const glm::vec4 background = scene.background.transparent ? glm::vec4(0.0f) : opaque_background(scene);
  begin_drawing(samples.framebuffer, samples.width, samples.height, false);
  const auto clear = [&]() -> Result<void> {
    clear_target(samples.framebuffer, background);
    return {};
  };
  DUBSAR_TRY(once(in_pieces ? &pieces_ : nullptr, clear));
  return draw_items(scene, {one, {}, samples.width, samples.height, 0.0}, shadows, factor,
                    {samples.framebuffer, samples.depth, -1}, in_pieces ? &pieces_ : nullptr);
}

/// The mean of the samples of each pixel.
void Renderer::resolve(const Scratch& scratch, int factor, ViewArray& target, int layer) {
  glNamedFramebufferTextureLayer(layer_, GL_COLOR_ATTACHMENT0, target.coded(), 0, layer);
  glBindFramebuffer(GL_FRAMEBUFFER, layer_);
  glViewport(0, 0, target.width(), target.height());
  glDisable(GL_DEPTH_TEST);
  glUseProgram(resolve_program_);
  glUniform1i(kFactorLocation, factor);
  glBindTextureUnit(0, scratch.color);
  glBindVertexArray(no_vertices_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace dubsar
