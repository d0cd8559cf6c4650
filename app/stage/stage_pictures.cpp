// Pictures of a stage that are not those of its display: stills, and pictures that exist already.

#include <algorithm>
#include <array>
#include <cmath>

#include "app/stage/ground_color.h"
#include "app/stage/stage_parts.h"
#include "display/render/images/test_pattern.h"

namespace dubsar::app {
/// Pictures that exist already, where another one is wanted than is there.
Result<void> Stage::Parts::fill_layers() {
  const SinkTraits traits = sink->traits();
  if (!options.pictures && options.subject != Subject::kPattern) {  // the ground alone
    const std::array<GLubyte, 4> ground{kGroundColor[0], kGroundColor[1], kGroundColor[2], 0xff};
    glClearTexImage(layers.array->coded(), 0, GL_RGBA, GL_UNSIGNED_BYTE, ground.data());
    return check_gl("clearing the views");
  }
  layers.chosen.resize(static_cast<std::size_t>(traits.views), -1);
  for (int layer = 0; layer < traits.views; ++layer) {
    int& there = layers.chosen[static_cast<std::size_t>(layer)];
    const bool swapped = next.viewer.swap_eyes && traits.views == 2;
    const int wanted = options.pictures ? picture_for_layer(*options.pictures, traits, layer, next.viewer)
                       : swapped        ? 1 - layer
                                        : layer;
    if (std::exchange(there, wanted) == wanted) continue;
    DUBSAR_TRY(layers.array->write_layer(
        layer, options.pictures ? layer_of_picture(options.pictures->views[static_cast<std::size_t>(wanted)],
                                                   options.pictures->aspect, traits, layer)
                                : numbered_view(traits.view.width, traits.view.height, wanted, traits.views)));
  }
  return {};
}

/// Upright behind the object: what has the same place in both views, as on panels, would be seen double.
Result<void> Stage::Parts::paint_page() {
  constexpr glm::dvec2 kPageMm{800.0, 600.0};
  constexpr int kPageHeightPx = 960;
  constexpr double kBehindMm = 250.0;
  if (!layers.page) {
    DUBSAR_ASSIGN(ViewArray text, ViewArray::create(kPageHeightPx * 4 / 3, kPageHeightPx, 1));
    DUBSAR_ASSIGN(PagePass pass, PagePass::create());
    layers.page = Page{std::move(text), std::move(pass)};
    layers.overlay_changed = true;
  }
  if (layers.overlay_changed) {
    const std::array<GLubyte, 4> nothing{};
    glClearTexImage(layers.page->text.coded(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nothing.data());
    DUBSAR_TRY(layers.overlay->paint(layers.page->text, kPageMm));
  }
  return layers.page->pass.draw(layers.page->text,
                                {{-0.5 * kPageMm.x, 0.0, -kBehindMm}, {kPageMm.x, 0.0, 0.0}, {0.0, kPageMm.y, 0.0}},
                                painted.views, *layers.array);
}

Result<Image> Stage::still(int factor) {
  Parts& p = *parts_;
  const PixelSize view = p.sink->traits().view;
  constexpr int kMostSide = 16384;
  if (factor < 1 || factor * std::max(view.width, view.height) > kMostSide)
    return fail(ErrorKind::kUsage, "picture: {} times {} x {} pixels asked for, expected at most {} on a side", factor,
                view.width, view.height, kMostSide);
  if (!p.has_mesh()) return fail(ErrorKind::kUsage, "picture: there is no surface");
  const auto all_there = [&](const Shown& shown) {
    return p.measured(p.of(shown)).covers(fields_needed(shown.style, shown.other));
  };
  if (!all_there(p.next.shown) || (p.has_beside() && !all_there(*p.next.shown.compared)))
    return fail(ErrorKind::kTryAgain,
                "picture: the surface is still being measured; ask again when its colours are there");
  if (!p.object.renderer) {
    DUBSAR_ASSIGN(p.object.renderer, Renderer::create());
  }
  const PixelSize whole{factor * view.width, factor * view.height};
  if (!p.in_halves()) return p.still_of(p.own_half(), factor, whole);
  DUBSAR_ASSIGN(Image first, p.still_of(0, factor, whole));
  DUBSAR_ASSIGN(const Image second, p.still_of(1, factor, whole));
  Image out(whole.width, whole.height, first.channels);
  for (int half = 0; half < 2; ++half) {
    const Image& part = half == 0 ? first : second;
    const glm::ivec2 corner = p.half_corner(half, whole);
    const int top = whole.height - corner.y - part.height;
    for (int y = 0; y < part.height; ++y)
      std::copy_n(part.at(0, y), static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.channels),
                  out.at(corner.x, top + y));
  }
  return out;
}

/// A half, or all where there are none, of a picture that has so many pixels.
Result<Image> Stage::Parts::still_of(int half, int factor, const PixelSize& whole) {
  const std::span<const View> views = sink->views(cameras(half));
  View middle = views[views.size() / 2];
  PixelSize size = whole;
  if (in_halves()) {
    middle = view_of_half(middle, half, whole);
    size = half_size(whole);
  }
  DUBSAR_ASSIGN(ViewArray array, ViewArray::create(size.width, size.height, 1));
  Painted before = painted;
  set_scene(shown_in(half), half);
  painted.judge.reset();                  // one view decides for itself
  for (DrawItem& item : painted.items) {  // as thick as they look in the window
    if (auto* lines = std::get_if<LinesItem>(&item)) lines->width_px *= factor;
    if (auto* label = std::get_if<LabelItem>(&item)) {
      label->height_px *= factor;
      label->shift_px *= factor;
    }
  }
  const auto drawn = object.renderer->render(scene(), std::span(&middle, 1), options.samples, array);
  painted = std::move(before);
  if (!drawn) return tl::unexpected<Error>(drawn.error());
  return array.read_layer(0);
}

Result<Image> Stage::thumbnail(const Shown& shown, int height) {
  Parts& p = *parts_;
  if (!p.has_mesh()) return fail(ErrorKind::kUsage, "thumbnail: there is no surface");
  if (p.cost.coarse > 0) return fail(ErrorKind::kTryAgain, "thumbnail: a picture is being made exact");
  const int width = std::max(1, static_cast<int>(std::lround(height * p.plane.window.x / p.plane.window.y)));
  DUBSAR_ASSIGN(ViewArray array, ViewArray::create(width, height, 1));
  const Parts::Next next = p.next;
  const Parts::Painted painted = p.painted;
  p.next.shown = shown;
  p.next.viewer = p.viewer_at(FollowedEyes());
  const std::span<const View> views = p.sink->views(p.cameras());
  const View middle = views[views.size() / 2];
  p.set_scene();
  const auto drawn = p.object.multi ? p.object.multi->draw_moving(p.scene(), std::span(&middle, 1), array)
                                    : p.object.renderer->render(p.scene(), std::span(&middle, 1), 1, array);
  p.next = next;
  p.painted = painted;
  if (!drawn) return tl::unexpected<Error>(drawn.error());
  return array.read_layer(0);
}

}  // namespace dubsar::app
