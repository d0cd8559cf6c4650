#include "display/renderer.h"

#include <algorithm>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <vector>

#include "display/srgb.h"

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

glm::vec3 linear(const Rgb8& c) { return glm::vec3(glm::dvec3(linear_from_srgb(c[0]), linear_from_srgb(c[1]), linear_from_srgb(c[2]))); }

ViewData view_data(const View& view, const Box& box) {
  glm::dmat4 world_from_unit(1.0);
  const glm::dvec3 size = box.size();
  for (int a = 0; a < 3; ++a) {
    world_from_unit[a][a] = size[a];
    world_from_unit[3][a] = box.min[a];
  }
  glm::dmat4 normals(glm::inverseTranspose(glm::dmat3(view.view_from_world)));
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

}  // namespace

Result<Renderer> Renderer::create() {
  if (glGetString(GL_VERSION) == nullptr)
    return fail(ErrorKind::kUnavailable, "render: no OpenGL context is current, expected GL 4.5");
  Renderer out;
  DUBSAR_ASSIGN(out.mesh_program_, make_program("mesh.vert", "mesh.frag"));
  DUBSAR_ASSIGN(out.resolve_program_, make_program("fullscreen.vert", "resolve.frag"));
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

Result<void> Renderer::render(const GpuMesh& mesh, const Shading& shading, std::span<const View> views, int factor,
                              ViewArray& target, int first_layer) {
  if (factor < 1 || factor > 8)
    return fail(ErrorKind::kUsage, "render: {0} x {0} samples a pixel asked for, expected 1 x 1 to 8 x 8", factor);
  DUBSAR_CHECK(first_layer >= 0 && first_layer + static_cast<std::int64_t>(views.size()) <= target.layers());
  if (views.empty()) return {};
  DUBSAR_TRY(use_scratch(target.width() * factor, target.height() * factor));

  std::vector<ViewData> data;
  for (const View& view : views) data.push_back(view_data(view, mesh.box_mm()));
  const GlBuffer view_buffer = make_buffer(std::as_bytes(std::span(data)));
  const StyleData style = style_data(shading);
  const GlBuffer style_buffer = make_buffer(std::as_bytes(std::span(&style, 1)));
  const auto table = color_table(shading);
  const GlTexture table_texture = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(table_texture, 1, GL_RGBA8, kShapeRows, kAoColumns);
  glTextureSubImage2D(table_texture, 0, 0, 0, kShapeRows, kAoColumns, GL_RGBA, GL_UNSIGNED_BYTE, table.data());
  const auto ranges = mesh.ranges(shading.partitions);

  glm::vec4 background(linear(shading.background), 1.0f);
  if (shading.transparent_background) background = glm::vec4(0.0f);

  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kViewsBinding, view_buffer);
  glBindBufferBase(GL_UNIFORM_BUFFER, kStyleBinding, style_buffer);
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

  for (std::size_t i = 0; i < views.size(); ++i) {
    glBindFramebuffer(GL_FRAMEBUFFER, scratch_.framebuffer);
    glViewport(0, 0, scratch_.width, scratch_.height);
    glEnable(GL_DEPTH_TEST);
    const float far_depth = 1.0f;
    glClearNamedFramebufferfv(scratch_.framebuffer, GL_COLOR, 0, &background[0]);
    glClearNamedFramebufferfv(scratch_.framebuffer, GL_DEPTH, 0, &far_depth);
    if (shading.back_faces == BackFaces::kCull)
      glEnable(GL_CULL_FACE);
    else
      glDisable(GL_CULL_FACE);
    glUseProgram(mesh_program_);
    glUniform1i(kViewIndexLocation, static_cast<GLint>(i));
    glBindTextureUnit(0, table_texture);
    glBindVertexArray(mesh.vertex_array());
    constexpr std::int64_t kMostAtOnce = std::numeric_limits<GLsizei>::max() / 3;
    for (auto [first, count] : ranges)
      for (; count > 0; first += kMostAtOnce, count -= kMostAtOnce)
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * std::min(count, kMostAtOnce)), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * sizeof(Triangle)));

    glNamedFramebufferTextureLayer(layer_, GL_COLOR_ATTACHMENT0, target.coded(), 0, first_layer + static_cast<GLint>(i));
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
