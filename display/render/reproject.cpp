#include "display/render/reproject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace dubsar {
namespace {

constexpr GLint kKey = 0, kShift = 1, kReach = 2, kFarDepth = 3;  // shaders/reproject.frag
constexpr double kTolerancePx = 0.05;

/// Pixels of the drawn view in which the surface that lands on a pixel can be, from that pixel.
std::pair<int, int> reach_of(const RowShift& shift, const DepthRange& depth) {
  const auto [least, most] = std::minmax({-shift.at(depth.nearest), -shift.at(depth.farthest)});
  return {static_cast<int>(std::floor(least - 0.5)),
          static_cast<int>(std::ceil(most + 0.5))};  // surfaces end half a pixel on
}

/// Pixels that can show the box, as glScissor() wants them.
std::array<GLint, 4> pixels_of(const View& view, const Box& box, int width, int height) {
  glm::dvec2 low(1.0), high(-1.0);
  const glm::dmat4 clip = view.clip_from_world();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 p = clip * glm::dvec4(box.corner(corner), 1.0);
    if (!(p.w > 0)) return {0, 0, width, height};
    low = glm::min(low, glm::dvec2(p) / p.w);
    high = glm::max(high, glm::dvec2(p) / p.w);
  }
  const auto pixel = [](double ndc, int size, double margin) {
    return static_cast<int>(std::clamp(std::floor(0.5 * (ndc + 1.0) * size + margin), 0.0, static_cast<double>(size)));
  };
  const int left = pixel(low.x, width, -1.0), right = pixel(high.x, width, 2.0);
  const int bottom = pixel(low.y, height, -1.0), top = pixel(high.y, height, 2.0);
  return {left, bottom, std::max(0, right - left), std::max(0, top - bottom)};
}

}  // namespace

std::optional<RowShift> row_shift(const View& from, const View& to, int width_px, int height_px) {
  glm::dmat4 m = to.clip_from_world() * glm::inverse(from.clip_from_world());
  if (!(std::abs(m[3][3]) > 0)) return std::nullopt;
  m *= 1.0 / m[3][3];
  // Columns are x, y, z, 1; all are -1..1.
  const double in_x = 2.0 * kTolerancePx / width_px, in_y = 2.0 * kTolerancePx / height_px;
  for (int c = 0; c < 4; ++c) {
    const double x = m[c][0] - (c == 0 ? 1.0 : 0.0), y = m[c][1] - (c == 1 ? 1.0 : 0.0),
                 w = m[c][3] - (c == 3 ? 1.0 : 0.0);
    if ((c < 2 && !(std::abs(x) < in_x)) || !(std::abs(y) < in_y) || !(std::abs(w) < std::min(in_x, in_y)))
      return std::nullopt;
  }
  return RowShift{width_px * m[2][0], 0.5 * width_px * (m[3][0] - m[2][0])};
}

DepthRange depth_range(const View& view, const Box& box) {
  DepthRange out{1.0, 0.0};
  const glm::dmat4 clip = view.clip_from_world();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 p = clip * glm::dvec4(box.corner(corner), 1.0);
    const double depth = p.w > 0 ? std::clamp(0.5 + 0.5 * p.z / p.w, 0.0, 1.0) : 0.0;
    out.nearest = std::min(out.nearest, depth);
    out.farthest = std::max(out.farthest, depth);
  }
  return out;
}

Result<Reprojector> Reprojector::create() {
  Reprojector out;
  DUBSAR_ASSIGN(out.program_, make_program("fullscreen.vert", "reproject.frag"));
  out.no_vertices_ = make_vertex_array();
  out.layer_ = make_framebuffer();
  return out;
}

Result<void> Reprojector::fill(ViewArray& target, GLuint depths, std::span<const View> views,
                               std::span<const int> drawn, const Box& box) {
  DUBSAR_CHECK(!drawn.empty() && static_cast<int>(views.size()) <= target.layers());
  const DepthRange depth = depth_range(views[static_cast<std::size_t>(drawn[0])], box);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glEnable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glBindFramebuffer(GL_FRAMEBUFFER, layer_);
  glViewport(0, 0, target.width(), target.height());
  glUseProgram(program_);
  glBindTextureUnit(0, target.coded());
  glBindTextureUnit(1, depths);
  glBindVertexArray(no_vertices_);
  glUniform1f(kFarDepth, static_cast<float>(depth.farthest));
  glTextureBarrier();  // layers of the texture that is drawn into are read: other ones, drawn before
  for (int i = 0; i < static_cast<int>(views.size()); ++i) {
    const auto above = std::lower_bound(drawn.begin(), drawn.end(), i);
    if (above != drawn.end() && *above == i) continue;
    int a = above == drawn.begin() ? *above : *(above - 1), b = above == drawn.end() ? *(above - 1) : *above;
    if (b - i < i - a) std::swap(a, b);  // the nearer one first
    const View& view = views[static_cast<std::size_t>(i)];
    const auto from_a = row_shift(views[static_cast<std::size_t>(a)], view, target.width(), target.height());
    const auto from_b = row_shift(views[static_cast<std::size_t>(b)], view, target.width(), target.height());
    DUBSAR_CHECK(from_a && from_b);
    const auto reach_a = reach_of(*from_a, depth), reach_b = reach_of(*from_b, depth);
    glNamedFramebufferTextureLayer(layer_, GL_COLOR_ATTACHMENT0, target.coded(), 0, i);
    glUniform2i(kKey, a, b);
    glUniform4f(kShift, static_cast<float>(from_a->slope), static_cast<float>(from_a->offset),
                static_cast<float>(from_b->slope), static_cast<float>(from_b->offset));
    glUniform4i(kReach, reach_a.first, reach_a.second, reach_b.first, reach_b.second);
    const auto pixels = pixels_of(view, box, target.width(), target.height());
    glScissor(pixels[0], pixels[1], pixels[2], pixels[3]);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glNamedFramebufferTexture(layer_, GL_COLOR_ATTACHMENT0, 0, 0);  // the target may go before us
  return check_gl("reprojecting views");
}

}  // namespace dubsar
