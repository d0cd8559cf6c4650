// Two states of an object side by side in every view.

#include <algorithm>

#include "app/viewer/stage/stage_parts.h"

namespace dubsar::app {

glm::dmat4 Stage::Parts::placed(const Shown& shown, int half) const {
  const double magnification = plane.magnification * shown.fit;
  if (!next.shown.beside)
    return app::screen_from_model(object.box, options.direction, shown.view, magnification, plane.window.y,
                                  plane.middle);
  // As large as fits into half the width, where that is what limits it.
  const double narrower = std::min(1.0, 0.5 * plane.window.x / std::min(plane.window.x, plane.window.y));
  const glm::dvec2 middle = plane.middle + glm::dvec2((half == 0 ? -0.25 : 0.25) * plane.window.x, 0.0);
  return app::screen_from_model(object.box, options.direction, shown.view, narrower * magnification, plane.window.y,
                                middle);
}

/// Each half is a picture of its own, so that nothing of one reaches into the other.
Result<void> Stage::Parts::paint_halves(bool exact) {
  ViewArray& whole = *layers.array;
  const int width = whole.width() / 2;
  if (!layers.half || layers.half->width() != width || layers.half->height() != whole.height() ||
      layers.half->layers() != whole.layers()) {
    DUBSAR_ASSIGN(layers.half, ViewArray::create(width, whole.height(), whole.layers()));
  }
  const std::shared_ptr<const Shown> beside = next.shown.beside;
  for (int half = 0; half < 2; ++half) {
    set_scene(half == 0 ? *beside : next.shown, half);
    const int left = half == 0 ? 0 : whole.width() - width;
    std::vector<View> views;
    for (const View& view : painted.views)
      views.push_back(crop_view(view, left, 0, width, whole.height(), whole.width(), whole.height()));
    if (!exact) {
      DUBSAR_TRY(object.multi->draw_moving(scene(), views, *layers.half));
    } else if (object.multi) {
      DUBSAR_TRY(object.multi->draw_exact(scene(), views, options.samples, *layers.half));
    } else {
      DUBSAR_TRY(object.renderer->render(scene(), views, options.samples, *layers.half));
    }
    glCopyImageSubData(layers.half->coded(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, whole.coded(), GL_TEXTURE_2D_ARRAY, 0,
                       left, 0, 0, width, whole.height(), whole.layers());
  }
  cost.coarse = exact ? 0 : whole.layers();
  return check_gl("drawing two states");
}

}  // namespace dubsar::app
