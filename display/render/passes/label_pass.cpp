#include "display/render/passes/label_pass.h"

#include <cmath>
#include <vector>

#include "display/render/images/label_font.h"
#include "display/render/images/utf8.h"
#include "display/render/passes/views_binding.h"

namespace dubsar {
namespace {

constexpr GLuint kLettersBinding = 1, kSeenBinding = 2;
constexpr double kPlacePx = 7.0;  // side of what is looked at of a label's place, of the picture
constexpr double kBorderEm = 0.07;
constexpr double kPlateAboveEm = 0.85, kPlateBelowEm = 0.3, kPlateAsideEm = 0.25;  // of the text's ground
constexpr float kNoSheet = -1.0f;                                                  // shaders/labels.frag

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
  if (item.plate > 0) {
    const double width = font.width_em(item.text) * px, aside = kPlateAsideEm * px;
    out.push_back(
        {glm::vec4(glm::dvec4(pen - aside, base - kPlateBelowEm * px, pen + width + aside, base + kPlateAboveEm * px)),
         glm::vec4(kNoSheet)});
  }
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

/// In samples of the target: whole ones, so that each square has the same number of them.
double place_side(double pixel) { return std::round(kPlacePx * pixel); }

}  // namespace

Result<LabelPass> LabelPass::create(bool layered) {
  LabelPass out;
  DUBSAR_ASSIGN(out.alone_.letters, make_program("labels.vert", "labels.frag"));
  DUBSAR_ASSIGN(out.alone_.places, make_program("label_place.vert", "label_place.frag"));
  if (layered) {
    DUBSAR_ASSIGN(out.layered_.letters, make_program("labels.vert", "labels.frag", kFlatLayered));
    DUBSAR_ASSIGN(out.layered_.places, make_program("label_place.vert", "label_place.frag", kFlatLayered));
  }
  out.no_vertices_ = make_vertex_array();
  for (GlBuffer* const buffer : {&out.views_, &out.letters_, &out.places_, &out.seen_}) *buffer = make_stream_buffer();
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

/// Counts in every view how much of a square over each place nothing hides.
void LabelPass::see_places(std::span<const LabelItem* const> labels, const PassViews& target, double side) {
  std::vector<glm::vec4> places;
  for (const LabelItem* const label : labels) places.emplace_back(label->at_mm, label->lift_mm);
  const std::vector<GLuint> none(labels.size() * target.views.size(), 0);
  stream(places_, std::as_bytes(std::span(places)));
  stream(seen_, std::as_bytes(std::span(none)));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSeenBinding, seen_);
  glUseProgram(target.layers.empty() ? alone_.places : layered_.places);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLettersBinding, places_);
  glUniform1i(0, static_cast<GLint>(places.size()));
  glUniform3f(1, static_cast<float>(target.width_px), static_cast<float>(target.height_px), static_cast<float>(side));
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthFunc(GL_LEQUAL);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(none.size()));
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void LabelPass::draw_letters(const LabelItem& item, const PassViews& target, double pixel) {
  const std::vector<Letter> letters = letters_of(item, item.height_px * pixel, pixel);
  if (letters.empty()) return;
  use_sheet(*item.font);
  stream(letters_, std::as_bytes(std::span(letters)));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLettersBinding, letters_);
  glBindTextureUnit(0, sheet_);
  const auto count = static_cast<GLsizei>(letters.size());
  glUniform1i(0, count);
  glUniform3f(1, static_cast<float>(target.width_px), static_cast<float>(target.height_px),
              static_cast<float>(item.lift_mm));
  const glm::vec3 at(item.at_mm), along(item.along_mm);
  glUniform3f(2, at.x, at.y, at.z);
  glUniform3f(3, along.x, along.y, along.z);
  const glm::vec4 fill = premultiplied(item.color, item.opacity), border = premultiplied(item.border, item.opacity);
  glUniform4f(4, fill.x, fill.y, fill.z, fill.w);
  glUniform4f(5, border.x, border.y, border.z, border.w);
  glUniform1f(6, static_cast<float>(kBorderEm * LabelFont::kEmPx * 0.5 / LabelFont::kSpreadPx));
  glUniform1f(12, static_cast<float>(item.plate));
  for (const bool nearer : {true, false}) {
    glUniform3f(8, static_cast<float>(place_side(pixel)), static_cast<float>(item.hidden_opacity),
                nearer ? 1.0f : 0.0f);
    glDepthFunc(nearer ? GL_GREATER : GL_LEQUAL);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count * static_cast<GLsizei>(target.views.size()));
  }
}

namespace {
std::vector<const LabelItem*> drawn_labels(std::span<const DrawItem> items) {
  std::vector<const LabelItem*> out;
  for (const DrawItem& item : items)
    if (const auto* label = std::get_if<LabelItem>(&item);
        label != nullptr && !label->text.empty() && label->opacity > 0)
      out.push_back(label);
  return out;
}
}  // namespace

void LabelPass::begin(const PassViews& target) {
  const std::vector<FlatView> views = flat_views(target);
  stream(views_, std::as_bytes(std::span(views)));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kViewsBinding, views_);
  glBindVertexArray(no_vertices_);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
}

Result<void> LabelPass::judge(std::span<const DrawItem> items, const PassViews& target, double pixel) {
  const std::vector<const LabelItem*> labels = drawn_labels(items);
  if (labels.empty()) return {};
  begin(target);
  see_places(labels, target, place_side(pixel));
  judge_clip_ = glm::mat4(target.views[0].clip_from_world());
  judge_measures_ = glm::vec4(glm::dvec4(target.width_px, target.height_px, place_side(pixel), 0.0));
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  return check_gl("looking at the places of labels");
}

Result<void> LabelPass::draw(std::span<const DrawItem> items, const PassViews& target, double pixel, bool judged) {
  const std::vector<const LabelItem*> labels = drawn_labels(items);
  if (labels.empty()) return {};
  begin(target);
  if (!judged) see_places(labels, target, place_side(pixel));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSeenBinding, seen_);
  glUseProgram(target.layers.empty() ? alone_.letters : layered_.letters);
  glUniform1i(9, judged ? 1 : 0);
  glUniform3f(10, judge_measures_.x, judge_measures_.y, judge_measures_.z);
  glUniformMatrix4fv(11, 1, GL_FALSE, &judge_clip_[0][0]);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // premultiplied
  for (std::size_t i = 0; i < labels.size(); ++i) {
    glUniform2i(7, static_cast<GLint>(i), static_cast<GLint>(labels.size()));
    draw_letters(*labels[i], target, pixel);
  }
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  return check_gl("drawing labels");
}

}  // namespace dubsar
