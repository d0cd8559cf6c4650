#include "display/render/passes/compose_pass.h"

#include <algorithm>

#include "display/render/view_array.h"

namespace dubsar {

Result<void> ComposePass::begin(const Surface& target, GLuint texture) {
  if (program_ == 0) {
    DUBSAR_ASSIGN(program_, make_program("fullscreen.vert", fragment_shader_));
    no_vertices_ = make_vertex_array();
  }
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  glViewport(0, 0, target.width, target.height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glUseProgram(program_);
  glBindTextureUnit(0, texture);
  glBindVertexArray(no_vertices_);
  return {};
}

Result<void> ComposePass::draw() {
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return check_gl("composing");
}

Result<void> LayerCopy::draw(const ViewArray& views, int layer, const Surface& target) {
  if (framebuffer_ == 0) framebuffer_ = make_framebuffer();
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glNamedFramebufferTextureLayer(framebuffer_, GL_COLOR_ATTACHMENT0, views.coded(), 0, layer);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
  if (target.width > views.width() || target.height > views.height()) {
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
  }
  const int width = std::min(target.width, views.width()), height = std::min(target.height, views.height());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0);  // the views may go before us
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return check_gl("copying a view");
}

Result<OffscreenSurface> OffscreenSurface::create(PixelSize size) {
  GLint max_side = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_side);
  if (size.width < 1 || size.height < 1 || size.width > max_side || size.height > max_side)
    return fail(ErrorKind::kUsage, "display: a picture of {} x {} pixels asked for, expected 1 to {} a side",
                size.width, size.height, max_side);
  OffscreenSurface out;
  out.size_ = size;
  out.color_ = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(out.color_, 1, GL_RGBA8, size.width, size.height);
  out.framebuffer_ = make_framebuffer();
  glNamedFramebufferTexture(out.framebuffer_, GL_COLOR_ATTACHMENT0, out.color_, 0);
  DUBSAR_TRY(check_gl("making an offscreen picture"));
  return out;
}

Result<Image> OffscreenSurface::read() const {
  Image image(size_.width, size_.height, 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(color_, 0, GL_RGB, GL_UNSIGNED_BYTE, static_cast<GLsizei>(image.pixels.size()),
                    image.pixels.data());
  DUBSAR_TRY(check_gl("reading the picture back"));
  for (int y = 0; y < size_.height / 2; ++y)
    std::swap_ranges(image.at(0, y), image.at(0, y) + std::ptrdiff_t{3} * size_.width,
                     image.at(0, size_.height - 1 - y));
  return image;
}

Result<void> fit_into(const Surface& picture, const Surface& target) {
  const double scale =
      std::min(static_cast<double>(target.width) / picture.width, static_cast<double>(target.height) / picture.height);
  const int width = std::max(1, static_cast<int>(scale * picture.width)),
            height = std::max(1, static_cast<int>(scale * picture.height));
  const int x = (target.width - width) / 2, y = (target.height - height) / 2;
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glBlitFramebuffer(0, 0, picture.width, picture.height, x, y, x + width, y + height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return check_gl("fitting a picture into the window");
}

}  // namespace dubsar
