#include "display/render/passes/page_pass.h"

#include <array>
#include <glm/gtc/type_ptr.hpp>

namespace dubsar {

Result<PagePass> PagePass::create() {
  PagePass out;
  DUBSAR_ASSIGN(out.program_, make_program("page.vert", "page.frag"));
  out.no_vertices_ = make_vertex_array();
  out.layer_ = make_framebuffer();
  return out;
}

Result<void> PagePass::draw(const ViewArray& page, const PagePlace& place, std::span<const View> views,
                            ViewArray& target) {
  DUBSAR_CHECK(static_cast<int>(views.size()) <= target.layers());
  glBindFramebuffer(GL_FRAMEBUFFER, layer_);
  glViewport(0, 0, target.width(), target.height());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(program_);
  glBindTextureUnit(0, page.coded());
  glBindVertexArray(no_vertices_);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const glm::dmat4 clip = views[i].clip_from_world();
    std::array<glm::vec4, 4> corners;
    for (std::size_t c = 0; c < corners.size(); ++c)
      corners[c] = clip * glm::dvec4(place.corner + static_cast<double>(c & 1) * place.right +
                                         static_cast<double>(c >> 1) * place.up,
                                     1.0);
    glUniform4fv(0, static_cast<GLsizei>(corners.size()), glm::value_ptr(corners[0]));
    glNamedFramebufferTextureLayer(layer_, GL_COLOR_ATTACHMENT0, target.coded(), 0, static_cast<GLint>(i));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDisable(GL_BLEND);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glNamedFramebufferTexture(layer_, GL_COLOR_ATTACHMENT0, 0, 0);  // the target may go before us
  return check_gl("drawing a page");
}

}  // namespace dubsar
