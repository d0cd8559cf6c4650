// Two states of an object, or two objects, side by side in every view.

#include <algorithm>

#include "app/stage/stage_parts.h"
#include "core/base/system/log.h"

namespace dubsar::app {

namespace {

double longest(const Box& box) {
  const glm::dvec3 size = box.size();
  return std::max({size.x, size.y, size.z, 1e-9});
}

}  // namespace

/// Takes in the surface beside the stage's own that is shown from now on.
void Stage::Parts::take_beside() {
  const std::shared_ptr<const TriMesh> wanted = has_beside() ? next.shown.compared->surface : nullptr;
  if (wanted != beside.kept) {
    beside = {};
    beside.kept = wanted;
    beside.source = wanted.get();
    object.refused = false;
    painted.of.reset();
    auto packed = wanted ? pack_mesh(*wanted) : Result<PackedMesh>(PackedMesh());
    if (wanted && packed) {
      beside.box = packed->box_mm;
      auto levels = make_levels(*std::move(packed), options.quality);
      if (levels) beside.mesh = *std::move(levels);
    }
    if (wanted && !beside.mesh) log_warning("view: the surface beside cannot be drawn");
  }
  if (!wanted || beside.mesh) return;
  next.shown.compared.reset();
  next.shown.caption.reset();
}

/// From the middle of the panel to that of a half.
glm::dvec2 Stage::Parts::half_middle(int half) const {
  const double side = half == 0 ? -1.0 : 1.0;
  if (!in_halves()) {  // in a room
    const double apart = 0.55 * plane.magnification * std::max(longest(object.box), longest(beside.box));
    return {side * apart, 0.0};
  }
  return upright() ? glm::dvec2(0.0, -0.25 * side * plane.window.y) : glm::dvec2(0.25 * side * plane.window.x, 0.0);
}

/// As large as fits into a half, where that is what limits it; of two surfaces the larger one fits.
double Stage::Parts::half_scale() const {
  if (!next.shown.compared || !in_halves()) return 1.0;
  const auto [low, high] = std::minmax(plane.window.x, plane.window.y);
  const double narrower = std::min(1.0, 0.5 * high / low);
  if (!beside.mesh || options.magnification > 0) return narrower;
  return narrower * longest(object.box) / std::max(longest(object.box), longest(beside.box));
}

glm::dmat4 Stage::Parts::placed(const Shown& shown, int half) const {
  const glm::dvec2 middle = plane.middle + (next.shown.compared ? half_middle(half) : glm::dvec2(0.0));
  return app::screen_from_model(of(shown).box, options.direction, shown.view,
                                half_scale() * plane.magnification * shown.fit, plane.window.y, middle);
}

/// What a half shows of a view that has `size` pixels.
View Stage::Parts::view_of_half(const View& whole, int half, const PixelSize& size) const {
  const PixelSize part = half_size(size);
  const glm::ivec2 corner = half_corner(half, size);
  return crop_view(whole, corner.x, corner.y, part.width, part.height, size.width, size.height);
}

/// The scene of a half, and its views.
std::vector<View> Stage::Parts::set_half(int half) {
  const PixelSize whole{layers.array->width(), layers.array->height()};
  set_scene(shown_in(half), half);
  std::vector<View> views;
  for (const View& view : sink->views(cameras(half))) views.push_back(view_of_half(view, half, whole));
  if (painted.judge) painted.judge = middle_view(views);
  return views;
}

Result<void> Stage::Parts::show_half(int half) {
  const ViewArray& drawn = *layers.half;
  ViewArray& whole = *layers.array;
  const glm::ivec2 corner = half_corner(half, {whole.width(), whole.height()});
  glCopyImageSubData(drawn.coded(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, whole.coded(), GL_TEXTURE_2D_ARRAY, 0, corner.x,
                     corner.y, 0, drawn.width(), drawn.height(), drawn.layers());
  return check_gl("drawing two states");
}

/// Each half is a picture of its own, so that nothing of one reaches into the other. Coarse ones are made exact by
/// refine_half().
Result<void> Stage::Parts::paint_halves() {
  const ViewArray& whole = *layers.array;
  const PixelSize part = half_size({whole.width(), whole.height()});
  if (!layers.half || !layers.half->measures(part.width, part.height, whole.layers())) {
    DUBSAR_ASSIGN(layers.half, ViewArray::create(part.width, part.height, whole.layers()));
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
