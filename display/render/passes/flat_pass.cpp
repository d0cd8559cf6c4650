#include "display/render/passes/flat_pass.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "display/render/passes/flat_views.h"
#include "display/render/passes/views_binding.h"

namespace dubsar {
namespace {

constexpr GLuint kPointsBinding = 1;

void blend() {
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // premultiplied
  glDisable(GL_CULL_FACE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void set_color(GLint location, const Rgb8& color, double opacity) {
  const glm::vec4 c = glm::vec4(linear_color(color), 1.0f) * static_cast<float>(opacity);
  glUniform4f(location, c.x, c.y, c.z, c.w);
}

}  // namespace

Result<FlatPass> FlatPass::create(bool layered) {
  FlatPass out;
  DUBSAR_ASSIGN(out.lines_, make_program("lines.vert", "lines.frag"));
  if (layered) {
    DUBSAR_ASSIGN(out.lines_layered_, make_program("lines.vert", "lines.frag", kFlatLayered));
  }
  out.no_vertices_ = make_vertex_array();
  out.views_ = make_stream_buffer();
  out.points_ = make_stream_buffer();
  return out;
}

void FlatPass::bind_views(const PassViews& target) {
  const std::vector<FlatView> data = flat_views(target);
  stream(views_, std::as_bytes(std::span(data)));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kViewsBinding, views_);
  glBindVertexArray(no_vertices_);
}

Result<void> FlatPass::draw(const LinesItem& item, const PassViews& target, double pixel) {
  if (item.points_mm.empty() || item.opacity == 0) return {};
  std::vector<glm::vec4> points;
  for (const glm::dvec3& p : item.points_mm) points.emplace_back(p, 1.0);
  const auto segments = static_cast<GLsizei>(points.size() / 2);
  glUseProgram(target.layers.empty() ? lines_ : lines_layered_);
  bind_views(target);
  stream(points_, std::as_bytes(std::span(points)));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kPointsBinding, points_);
  glUniform1i(0, segments);
  glUniform4f(1, static_cast<float>(target.width_px), static_cast<float>(target.height_px),
              static_cast<float>(0.5 * item.width_px * pixel), static_cast<float>(item.lift_mm));
  blend();
  glDepthMask(GL_FALSE);
  const auto draw_with = [&](GLenum depth_function, double opacity) {
    if (opacity == 0) return;
    set_color(2, item.color, opacity);
    glDepthFunc(depth_function);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, segments * static_cast<GLsizei>(target.views.size()));
  };
  draw_with(GL_GREATER, item.opacity * item.hidden_opacity);
  glDepthMask(GL_TRUE);
  draw_with(GL_LEQUAL, item.opacity);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  return check_gl("drawing lines");
}

}  // namespace dubsar
