// What stands over the pictures of a stage at the depth of the surface: a magnifying glass, and where the pointer is.

#include <algorithm>
#include <cmath>

#include "app/stage/pick_camera.h"
#include "app/stage/stage_parts.h"

namespace dubsar::app {
namespace {

constexpr GLint kLayer = 0, kPlace = 1, kRing = 2;  // shaders/lens.frag
constexpr double kRingShare = 0.028;                // of the view's height
constexpr int kProbe = 8192;                        // places across the window that the pointer tells apart

struct MarkPlace {
  double x = 0.0, y = 0.0;  ///< pixels from the lower left corner
  bool before = false;      ///< the eye is not behind it
};
MarkPlace mark_place(const View& view, const glm::dvec3& world, const ViewArray& array) {
  const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(world, 1.0);
  if (!(clip.w > 0)) return {};
  return {(0.5 + 0.5 * clip.x / clip.w) * array.width(), (0.5 + 0.5 * clip.y / clip.w) * array.height(), true};
}

}  // namespace

/// Pixels of a layer need not be square: the glass is round on the panel.
Result<void> Stage::Parts::paint_overlay_marks(ViewArray& array) {
  if (!overlay_marks.shown.any() || !has_mesh() || painted.views.empty()) return {};
  if (overlay_marks.program == 0) {
    DUBSAR_ASSIGN(overlay_marks.program, make_program("fullscreen.vert", "lens.frag"));
    overlay_marks.no_vertices = make_vertex_array();
    overlay_marks.framebuffer = make_framebuffer();
  }
  if (next.shown.compared) set_scene();  // the other state may have been drawn last
  const glm::dmat4 world = placed();
  const auto at = [&](const glm::dvec3& model) { return glm::dvec3(world * glm::dvec4(model, 1.0)); };
  const int side =
      overlay_marks.shown.magnifier
          ? std::clamp(static_cast<int>(overlay_marks.shown.magnifier->size * array.height()), 16, kMostMagnifierPx)
          : 0;
  if (overlay_marks.shown.magnifier) {
    if (!overlay_marks.pictures || overlay_marks.pictures->width() != side ||
        overlay_marks.pictures->layers() != array.layers()) {
      DUBSAR_ASSIGN(overlay_marks.pictures, ViewArray::create(side, side, array.layers()));
    }
    if (!object.renderer) {
      DUBSAR_ASSIGN(object.renderer, Renderer::create());
    }
  }
  for (int layer = 0; layer < array.layers(); ++layer) {
    const View& view = painted.views[static_cast<std::size_t>(layer)];
    if (overlay_marks.shown.magnifier) {
      const MarkPlace middle = mark_place(view, at(overlay_marks.shown.magnifier->at_mm), array);
      const int seen = std::max(2, static_cast<int>(std::lround(side / overlay_marks.shown.magnifier->factor)));
      const View part =
          crop_view(view, static_cast<int>(std::lround(middle.x - 0.5 * seen)),
                    static_cast<int>(std::lround(middle.y - 0.5 * seen)), seen, seen, array.width(), array.height());
      if (middle.before) {
        DUBSAR_TRY(
            object.renderer->render(scene(), std::span(&part, 1), kMagnifierSamples, *overlay_marks.pictures, layer));
        DUBSAR_TRY(stamp(array, layer, {middle.x - 0.5 * side, middle.y - 0.5 * side}, side, false));
      }
    }
    if (overlay_marks.shown.cursor_mm) {
      const MarkPlace middle = mark_place(view, at(*overlay_marks.shown.cursor_mm), array);
      const int ring = std::max(9, static_cast<int>(kRingShare * array.height()));
      if (middle.before) DUBSAR_TRY(stamp(array, layer, {middle.x - 0.5 * ring, middle.y - 0.5 * ring}, ring, true));
    }
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return check_gl("drawing the magnifier");
}

Result<void> Stage::Parts::stamp(ViewArray& array, int layer, const glm::dvec2& corner, int side, bool ring) {
  glNamedFramebufferTextureLayer(overlay_marks.framebuffer, GL_COLOR_ATTACHMENT0, array.coded(), 0, layer);
  glBindFramebuffer(GL_FRAMEBUFFER, overlay_marks.framebuffer);
  glViewport(0, 0, array.width(), array.height());
  glEnable(GL_SCISSOR_TEST);
  glScissor(static_cast<GLint>(std::floor(corner.x)), static_cast<GLint>(std::floor(corner.y)), side + 1, side + 1);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glUseProgram(overlay_marks.program);
  glUniform1i(kLayer, layer);
  glUniform3f(kPlace, static_cast<float>(std::lround(corner.x)), static_cast<float>(std::lround(corner.y)),
              static_cast<float>(side));
  glUniform1i(kRing, ring ? 1 : 0);
  if (!ring) glBindTextureUnit(0, overlay_marks.pictures->coded());
  glBindVertexArray(overlay_marks.no_vertices);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
  return {};
}

void Stage::set_overlay_marks(const OverlayMarks& marks) {
  if (marks == parts_->overlay_marks.shown) return;
  parts_->overlay_marks.shown = marks;
  parts_->layers.overlay_changed = true;
}

/// By drawing the one pixel that the middle of the eyes sees there.
Result<std::optional<glm::dvec3>> Stage::place_at(const glm::dvec2& at) {
  Parts& p = *parts_;
  if (!p.has_mesh()) return std::nullopt;
  if (!p.object.renderer) {
    DUBSAR_ASSIGN(p.object.renderer, Renderer::create());
  }
  if (!p.overlay_marks.probe) {
    DUBSAR_ASSIGN(p.overlay_marks.probe, ViewArray::create(1, 1, 1));
  }
  const glm::dvec2 half = 0.5 * p.plane.window, middle = p.plane.middle;
  const WindowRect window{
      {middle - half, 0.0}, {middle.x + half.x, middle.y - half.y, 0.0}, {middle.x - half.x, middle.y + half.y, 0.0}};
  const Observer eyes = p.cameras();
  const View whole = viewer_view(window, eyes, eyes.centre_mm());
  const double aspect = p.plane.window.y / p.plane.window.x;
  const int x = static_cast<int>(std::floor((0.5 + at.x * aspect) * kProbe)),
            y = static_cast<int>(std::floor((0.5 + at.y) * kProbe));
  const View one = crop_view(whole, x, y, 1, 1, kProbe, kProbe);
  if (other_half(p.next.shown, p.plane.window, at)) return std::nullopt;
  Parts::Painted before = std::exchange(p.painted, {});
  p.set_scene();
  std::erase_if(p.painted.items, [](const DrawItem& item) { return !std::holds_alternative<MeshItem>(item); });
  p.painted.light.shadows = false;
  const int layer = 0;
  const auto drawn =
      p.object.renderer->render_layers(p.scene(), std::span(&one, 1), std::span(&layer, 1), *p.overlay_marks.probe);
  p.painted = std::move(before);
  if (!drawn) return tl::unexpected<Error>(drawn.error());
  float depth = 1.0f;
  glGetTextureSubImage(p.object.renderer->layer_depths(), 0, 0, 0, 0, 1, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT,
                       sizeof(depth), &depth);
  if (depth >= 1.0f) return std::nullopt;
  const glm::dvec4 world = glm::inverse(one.clip_from_world()) * glm::dvec4(0.0, 0.0, 2.0 * depth - 1.0, 1.0);
  return glm::dvec3(glm::inverse(p.placed()) * glm::dvec4(glm::dvec3(world) / world.w, 1.0));
}

}  // namespace dubsar::app
