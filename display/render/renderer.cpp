#include "display/render/renderer.h"

#include <algorithm>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <vector>

#include "display/optics/srgb.h"

namespace dubsar {
namespace {

constexpr GLint kViewIndexLocation = 0, kFactorLocation = 0;  // shaders/mesh.vert, shaders/resolve.frag
constexpr GLuint kViewsBinding = 0, kStyleBinding = 1, kForeignColor = 3;

struct ViewData {  // std430, as in shaders/mesh.vert
  glm::mat4 view_from_unit, clip_from_view, view_from_normal;
};

struct StyleData {  // std140, as in shaders/mesh.vert
  glm::vec4 light, weights, back_color, shininess;
  std::array<glm::vec4, kMaxPartitions> partition_color;
};

glm::vec3 linear(const Rgb8& c) {
  return glm::vec3(glm::dvec3(linear_from_srgb(c[0]), linear_from_srgb(c[1]), linear_from_srgb(c[2])));
}

ViewData view_data(const View& view, const Box& box, int layer) {
  glm::dmat4 world_from_unit(1.0);
  const glm::dvec3 size = box.size();
  for (int a = 0; a < 3; ++a) {
    world_from_unit[a][a] = size[a];
    world_from_unit[3][a] = box.min[a];
  }
  glm::dmat4 normals(glm::inverseTranspose(glm::dmat3(view.view_from_world)));
  normals[3][0] = layer;
  normals[3][3] = view.orthographic() ? 1.0 : 0.0;
  return {glm::mat4(view.view_from_world * world_from_unit), glm::mat4(view.clip_from_view), glm::mat4(normals)};
}

StyleData style_data(const Shading& s) {
  StyleData out{};
  out.light = glm::vec4(glm::vec3(light_direction(s)), s.lit ? 1.0f : 0.0f);
  out.weights = glm::vec4(glm::dvec4(s.ambient, s.key, s.fill, s.specular));
  out.back_color = glm::vec4(linear(s.back_color), s.back_faces == BackFaces::kTint ? 1.0f : 0.0f);
  out.shininess = glm::vec4(static_cast<float>(s.shininess));
  for (int p = 0; p < kMaxPartitions; ++p) out.partition_color[p] = glm::vec4(linear(s.partition_colors[p]), 1.0f);
  return out;
}

glm::vec4 background_of(const Shading& shading) {
  return shading.transparent_background ? glm::vec4(0.0f) : glm::vec4(linear(shading.background), 1.0f);
}

void cull_as(const Shading& shading) {
  if (shading.back_faces == BackFaces::kCull)
    glEnable(GL_CULL_FACE);
  else
    glDisable(GL_CULL_FACE);
}

void draw_ranges(const std::vector<std::pair<std::int64_t, std::int64_t>>& ranges, GLsizei instances) {
  constexpr std::int64_t kMostAtOnce = std::numeric_limits<GLsizei>::max() / 3;
  for (auto [first, count] : ranges)
    for (; count > 0; first += kMostAtOnce, count -= kMostAtOnce)
      glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(3 * std::min(count, kMostAtOnce)), GL_UNSIGNED_INT,
                              reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * sizeof(Triangle)),
                              instances);
}

}  // namespace

Result<Renderer> Renderer::create(bool layered) {
  if (glGetString(GL_VERSION) == nullptr)
    return fail(ErrorKind::kUnavailable, "render: no OpenGL context is current, expected GL 4.5");
  Renderer out;
  DUBSAR_ASSIGN(out.mesh_program_, make_program("mesh.vert", "mesh.frag"));
  DUBSAR_ASSIGN(out.resolve_program_, make_program("fullscreen.vert", "resolve.frag"));
  if (layered && epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array")) {
    DUBSAR_ASSIGN(out.layered_program_,
                  make_program("mesh.vert", "mesh.frag",
                               "#extension GL_ARB_shader_viewport_layer_array : require\n#define LAYERED\n"));
  }
  out.no_vertices_ = make_vertex_array();
  out.layer_ = make_framebuffer();
  DUBSAR_TRY(check_gl("making the renderer"));
  return out;
}

Result<void> Renderer::use_scratch(int width, int height) {
  if (scratch_.width == width && scratch_.height == height) return {};
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
  scratch_ = std::move(made);
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

Renderer::Inputs Renderer::bind_inputs(const GpuMesh& mesh, const Shading& shading, std::span<const View> views,
                                       std::span<const int> layers) {
  std::vector<ViewData> data;
  for (std::size_t i = 0; i < views.size(); ++i)
    data.push_back(view_data(views[i], mesh.box_mm(), layers.empty() ? 0 : layers[i]));
  Inputs out;
  out.views = make_buffer(std::as_bytes(std::span(data)));
  const StyleData style = style_data(shading);
  out.style = make_buffer(std::as_bytes(std::span(&style, 1)));
  const auto table = color_table(shading);
  out.table = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(out.table, 1, GL_RGBA8, kShapeRows, kAoColumns);
  glTextureSubImage2D(out.table, 0, 0, 0, kShapeRows, kAoColumns, GL_RGBA, GL_UNSIGNED_BYTE, table.data());

  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kViewsBinding, out.views);
  glBindBufferBase(GL_UNIFORM_BUFFER, kStyleBinding, out.style);
  glVertexAttrib4f(kForeignColor, 1, 1, 1, 1);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glFrontFace(mesh.mirrored() ? GL_CW : GL_CCW);
  glCullFace(GL_BACK);
  return out;
}

Result<void> Renderer::render_layers(const GpuMesh& mesh, const Shading& shading, std::span<const View> views,
                                     std::span<const int> layers, ViewArray& target) {
  DUBSAR_CHECK(views.size() == layers.size());
  for (const int layer : layers) DUBSAR_CHECK(layer >= 0 && layer < target.layers());
  if (views.empty()) return {};
  DUBSAR_TRY(use_layer_depth(target));
  const bool together = layered_program_ != 0;
  const Inputs inputs = bind_inputs(mesh, shading, views, layers);
  const GLuint framebuffer = layer_depth_.framebuffer;
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, target.linear(), 0);
  glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, layer_depth_.depth, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glEnable(GL_FRAMEBUFFER_SRGB);  // the shader's linear light becomes sRGB bytes
  glViewport(0, 0, target.width(), target.height());
  glEnable(GL_DEPTH_TEST);
  cull_as(shading);
  glUseProgram(together ? layered_program_ : mesh_program_);
  glBindTextureUnit(0, inputs.table);
  glBindVertexArray(mesh.vertex_array());
  const glm::vec4 background(linear(shading.background), 1.0f);
  const float far_depth = 1.0f;
  glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, &background[0]);
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &far_depth);
  if (together) draw_ranges(mesh.visible_ranges(shading.partitions, views), static_cast<GLsizei>(views.size()));
  for (std::size_t i = 0; i < views.size() && !together; ++i) {
    glNamedFramebufferTextureLayer(framebuffer, GL_COLOR_ATTACHMENT0, target.linear(), 0, layers[i]);
    glNamedFramebufferTextureLayer(framebuffer, GL_DEPTH_ATTACHMENT, layer_depth_.depth, 0, layers[i]);
    glUniform1i(kViewIndexLocation, static_cast<GLint>(i));
    draw_ranges(mesh.visible_ranges(shading.partitions, views.subspan(i, 1)), 1);
  }
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, 0, 0);  // the target may go before us
  return check_gl("drawing layers");
}

Result<void> Renderer::render(const GpuMesh& mesh, const Shading& shading, std::span<const View> views, int factor,
                              ViewArray& target, int first_layer) {
  if (factor < 1 || factor > 8)
    return fail(ErrorKind::kUsage, "render: {0} x {0} samples a pixel asked for, expected 1 x 1 to 8 x 8", factor);
  DUBSAR_CHECK(first_layer >= 0 && first_layer + static_cast<std::int64_t>(views.size()) <= target.layers());
  if (views.empty()) return {};
  DUBSAR_TRY(use_scratch(target.width() * factor, target.height() * factor));

  const Inputs inputs = bind_inputs(mesh, shading, views, {});
  const glm::vec4 background = background_of(shading);

  for (std::size_t i = 0; i < views.size(); ++i) {
    glBindFramebuffer(GL_FRAMEBUFFER, scratch_.framebuffer);
    glViewport(0, 0, scratch_.width, scratch_.height);
    glEnable(GL_DEPTH_TEST);
    const float far_depth = 1.0f;
    glClearNamedFramebufferfv(scratch_.framebuffer, GL_COLOR, 0, &background[0]);
    glClearNamedFramebufferfv(scratch_.framebuffer, GL_DEPTH, 0, &far_depth);
    cull_as(shading);
    glUseProgram(mesh_program_);
    glUniform1i(kViewIndexLocation, static_cast<GLint>(i));
    glBindTextureUnit(0, inputs.table);
    glBindVertexArray(mesh.vertex_array());
    draw_ranges(mesh.visible_ranges(shading.partitions, views.subspan(i, 1)), 1);

    glNamedFramebufferTextureLayer(layer_, GL_COLOR_ATTACHMENT0, target.coded(), 0,
                                   first_layer + static_cast<GLint>(i));
    glBindFramebuffer(GL_FRAMEBUFFER, layer_);
    glViewport(0, 0, target.width(), target.height());
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glUseProgram(resolve_program_);
    glUniform1i(kFactorLocation, factor);
    glBindTextureUnit(0, scratch_.color);
    glBindVertexArray(no_vertices_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return check_gl("drawing");
}

}  // namespace dubsar
