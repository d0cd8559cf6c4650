// Two states of an object side by side in every view.

#include <algorithm>

#include "app/stage/stage_parts.h"

namespace dubsar::app {

glm::dmat4 Stage::Parts::placed(const Shown& shown, int half) const {
  const double magnification = plane.magnification * shown.fit;
  if (!next.shown.compared)
    return app::screen_from_model(object.box, options.direction, shown.view, magnification, plane.window.y,
                                  plane.middle);
  // As large as fits into half the width, where that is what limits it.
  const double narrower = std::min(1.0, 0.5 * plane.window.x / std::min(plane.window.x, plane.window.y));
  const glm::dvec2 middle = plane.middle + glm::dvec2((half == 0 ? -0.25 : 0.25) * plane.window.x, 0.0);
  return app::screen_from_model(object.box, options.direction, shown.view, narrower * magnification, plane.window.y,
                                middle);
}

/// The scene of a half, and its views.
std::vector<View> Stage::Parts::set_half(int half) {
  const ViewArray& whole = *layers.array;
  const int width = whole.width() / 2, left = half == 0 ? 0 : whole.width() - width;
  const Shown& shown = half == 0 ? *next.shown.compared : next.shown;
  set_scene(shown, half);
  std::vector<View> views;
  for (const View& view : sink->views(cameras(half)))
    views.push_back(crop_view(view, left, 0, width, whole.height(), whole.width(), whole.height()));
  if (painted.judge) painted.judge = middle_view(views);
  return views;
}

Result<void> Stage::Parts::show_half(int half) {
  const ViewArray& drawn = *layers.half;
  ViewArray& whole = *layers.array;
  glCopyImageSubData(drawn.coded(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, whole.coded(), GL_TEXTURE_2D_ARRAY, 0,
                     half == 0 ? 0 : whole.width() - drawn.width(), 0, 0, drawn.width(), drawn.height(),
                     drawn.layers());
  return check_gl("drawing two states");
}

/// Each half is a picture of its own, so that nothing of one reaches into the other. Coarse ones are made exact by
/// refine_half().
Result<void> Stage::Parts::paint_halves() {
  const ViewArray& whole = *layers.array;
  const int width = whole.width() / 2;
  if (!layers.half || !layers.half->measures(width, whole.height(), whole.layers())) {
    DUBSAR_ASSIGN(layers.half, ViewArray::create(width, whole.height(), whole.layers()));
  }
  for (int half = 0; half < 2; ++half) {
    const std::vector<View> views = set_half(half);
    if (object.multi) {
      DUBSAR_TRY(object.multi->draw_moving(scene(), views, *layers.half, 2));
    } else {
      DUBSAR_TRY(object.renderer->render(scene(), views, options.samples, *layers.half));
    }
    DUBSAR_TRY(show_half(half));
  }
  cost.coarse = object.multi ? 2 * whole.layers() : 0;
  cost.half.reset();
  return {};
}

/// A piece of the half that is next, the present state's first; it is seen when all its views are exact.
Result<void> Stage::Parts::refine_half(TimestampNs end) {
  const int views_of_half = layers.array->layers(), half = cost.coarse > views_of_half ? 1 : 0;
  const std::vector<View> views = set_half(half);
  if (cost.half != half) object.multi->begin_refining(views_of_half);
  cost.half = half;
  DUBSAR_ASSIGN(const int coarse, object.multi->refine_until(end, scene(), views, options.samples, *layers.half));
  cost.coarse = half * views_of_half + coarse;
  if (coarse > 0) return {};
  cost.refined = true;
  return show_half(half);
}

}  // namespace dubsar::app
