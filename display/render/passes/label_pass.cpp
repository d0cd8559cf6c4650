#include "display/render/passes/label_pass.h"

#include "display/render/images/label_font.h"
#include "display/render/images/utf8.h"
#include "display/render/passes/views_binding.h"

namespace dubsar {
namespace {

constexpr GLuint kLettersBinding = 1;
constexpr double kBorderEm = 0.07;

struct Letter {  // std430, as in shaders/labels.vert
  glm::vec4 place, sheet;
};

glm::vec4 premultiplied(const Rgb8& color, double opacity) {
  return glm::vec4(linear_color(color), 1.0f) * static_cast<float>(opacity);
}

/// `px` is the height of the letters in samples of the target.
std::vector<Letter> letters_of(const LabelItem& item, double px, double pixel) {
  LabelFont& font = *item.font;
  const std::vector<unsigned> codes = code_points(item.text);
  for (const unsigned code : codes) font.glyph(code);  // a full sheet begins anew before places are taken from it
  const double scale = px / LabelFont::kEmPx;
  double pen = pixel * item.shift_px.x - item.anchor * font.width_em(item.text) * px;
  const double base = pixel * item.shift_px.y;
  std::vector<Letter> out;
  for (const unsigned code : codes) {
    const LabelFont::Glyph& glyph = font.glyph(code);
    if (glyph.width > 0) {
      const double left = pen + scale * glyph.left, top = base + scale * glyph.top;
      const glm::dvec4 sheet(glyph.x, glyph.y + glyph.height, glyph.x + glyph.width, glyph.y);
      out.push_back({glm::vec4(glm::dvec4(left, top - scale * glyph.height, left + scale * glyph.width, top)),
                     glm::vec4(sheet / static_cast<double>(LabelFont::kSide))});
    }
    pen += scale * glyph.advance;
  }
  return out;
}

}  // namespace

Result<LabelPass> LabelPass::create(bool layered) {
  LabelPass out;
  DUBSAR_ASSIGN(out.program_, make_program("labels.vert", "labels.frag"));
  if (layered) {
    DUBSAR_ASSIGN(out.layered_, make_program("labels.vert", "labels.frag", kFlatLayered));
  }
  out.no_vertices_ = make_vertex_array();
  out.views_ = make_stream_buffer();
  out.letters_ = make_stream_buffer();
  return out;
}

void LabelPass::use_sheet(const LabelFont& font) {
  if (font_ == &font && version_ == font.version()) return;
  if (font_ == nullptr) {
    sheet_ = make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(sheet_, 1, GL_R8, LabelFont::kSide, LabelFont::kSide);
    glTextureParameteri(sheet_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(sheet_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(sheet_, 0, 0, 0, LabelFont::kSide, LabelFont::kSide, GL_RED, GL_UNSIGNED_BYTE,
                      font.sheet().data());
  font_ = &font;
  version_ = font.version();
}

Result<void> LabelPass::draw(const LabelItem& item, const PassViews& target, double pixel) {
  if (item.text.empty() || item.opacity == 0) return {};
  const std::vector<Letter> letters = letters_of(item, item.height_px * pixel, pixel);
  if (letters.empty()) return {};
  use_sheet(*item.font);
  glUseProgram(target.layers.empty() ? program_ : layered_);
  const std::vector<FlatView> views = flat_views(target);
  stream(views_, std::as_bytes(std::span(views)));
  stream(letters_, std::as_bytes(std::span(letters)));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kViewsBinding, views_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLettersBinding, letters_);
  glBindVertexArray(no_vertices_);
  glBindTextureUnit(0, sheet_);
  const auto count = static_cast<GLsizei>(letters.size());
  glUniform1i(0, count);
  glUniform3f(1, static_cast<float>(target.width_px), static_cast<float>(target.height_px),
              static_cast<float>(item.lift_mm));
  const glm::vec3 at(item.at_mm), along(item.along_mm);
  glUniform3f(2, at.x, at.y, at.z);
  glUniform3f(3, along.x, along.y, along.z);
  glUniform1f(6, static_cast<float>(kBorderEm * LabelFont::kEmPx * 0.5 / LabelFont::kSpreadPx));
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // premultiplied
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  const auto draw_with = [&](GLenum depth_function, double opacity) {
    if (opacity == 0) return;
    const glm::vec4 fill = premultiplied(item.color, opacity), border = premultiplied(item.border, opacity);
    glUniform4f(4, fill.x, fill.y, fill.z, fill.w);
    glUniform4f(5, border.x, border.y, border.z, border.w);
    glDepthFunc(depth_function);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count * static_cast<GLsizei>(target.views.size()));
  };
  draw_with(GL_GREATER, item.opacity * item.hidden_opacity);
  draw_with(GL_LEQUAL, item.opacity);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  return check_gl("drawing a label");
}

}  // namespace dubsar
