#include "app/stage/stage.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/document/gallery_picture.h"
#include "app/stage/stage_parts.h"
#include "core/base/system/budget.h"
#include "core/base/system/log.h"
#include "display/optics/comfort.h"
#include "display/render/images/test_pattern.h"
#include "display/render/view_array.h"
#include "display/sinks/render_display.h"

namespace dubsar::app {
namespace {

constexpr std::uint64_t kBytesPerViewPixel = 4;
constexpr double kEyeStepMm = 0.05;  // what an eye may move before there is a new picture
constexpr double kMovingMs = 16.0;   // of 33 for 30 pictures a second: the rest is for panels and the window
constexpr double kGroundMm = 30.0;   // of nothing, so that there is a scale
constexpr double kForget = 0.3;      // of the mean time that a view takes

double milliseconds_since(TimestampNs start) { return 1e-6 * static_cast<double>(SteadyClock().now() - start); }

struct ShownRect {
  glm::dvec2 middle{0.0}, size{0.0};
};

/// What a view shows of the panel's plane, in mm.
ShownRect shown_mm(const View& view) {
  const auto ndc = [&](const glm::dvec3& p) {
    const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(p, 1.0);
    return glm::dvec2(clip) / clip.w;
  };
  const glm::dvec2 origin = ndc({0, 0, 0});
  const glm::dvec2 per_mm{(ndc({1, 0, 0}) - origin).x, (ndc({0, 1, 0}) - origin).y};
  return {-origin / per_mm, 2.0 / per_mm};
}

}  // namespace

glm::dmat4 screen_from_model(const Box& box, const ViewDirection& direction, const ViewState& view,
                             double magnification, double window_height_mm, const glm::dvec2& middle_mm) {
  const glm::dmat4 moved = glm::translate(
      glm::dmat4(1.0), glm::dvec3(middle_mm + view.pan * window_height_mm, view.nearer * window_height_mm));
  const glm::dmat4 zoomed = glm::scale(glm::dmat4(1.0), glm::dvec3(view.zoom));
  return moved * zoomed * glm::mat4_cast(view.rotation) * place_object(box, direction, {0, 0, 0}, magnification);
}

/// Configures a sink and makes the layers for it; nothing changes when that fails.
Result<void> Stage::Parts::prepare(OutputSink& with) {
  DUBSAR_TRY(with.configure(options.screen));
  const SinkTraits traits = with.traits();
  if (traits.stereo_visual && !options.stereo_window)
    return fail(ErrorKind::kUnavailable, "display {}: needs a window with a stereo visual", traits.name);
  DUBSAR_TRY(check_memory("display", kBytesPerViewPixel * static_cast<std::uint64_t>(traits.view.width) *
                                         static_cast<std::uint64_t>(traits.view.height) *
                                         static_cast<std::uint64_t>(traits.views)));
  // On a quilt they are 45 MB, which another surface on the same panel need not ask of the system again.
  if (!layers.array || !layers.array->measures(traits.view.width, traits.view.height, traits.views)) {
    DUBSAR_ASSIGN(ViewArray made, ViewArray::create(traits.view.width, traits.view.height, traits.views));
    if (const auto& before = layers.array)
      cost.exact_view_ms *= static_cast<double>(made.width()) * made.height() / before->width() / before->height();
    layers.array = std::move(made);
    layers.overlaid.reset();
  }
  layers.chosen.clear();
  painted.of.reset();
  cost.coarse = 0;
  cost.prepared_at = next.now;
  const ShownRect rect = shown_mm(with.views(Observer())[0]);
  plane.window = rect.size;
  plane.middle = rect.middle;
  // A window on a plain monitor is looked at straight; before a panel of lenses people are where the panel wants them.
  plane.aside_mm = traits.exact_pixels ? glm::dvec3(0.0) : glm::dvec3(plane.middle, 0.0);
  // The longest edge fits both ways, so that every side of the object does.
  const glm::dvec3 size = object.box.size();
  const GalleryRoom gallery =
      options.room.gallery ? gallery_room(rect.size.x / rect.size.y) : GalleryRoom{.words = 0.0};
  plane.magnification = options.magnification > 0 ? options.magnification
                        : traits.worn
                            ? 1.0  // life size
                            : std::min((1.0 - 2.0 * std::max(options.room.margin, gallery.sides)) * rect.size.x,
                                       (1.0 - 2.0 * std::max(options.room.margin, gallery.words)) * rect.size.y) /
                                  std::max({size.x, size.y, size.z, 1e-9});
  return {};
}

Observer Stage::Parts::viewer_at(const FollowedEyes& eyes) const {
  Observer out = options.viewer;
  out.left_mm += plane.aside_mm;
  out.right_mm += plane.aside_mm;
  out.nominal_mm += plane.aside_mm;
  if (eyes.presence != Presence::kOff) {
    out.left_mm = 1e3 * eyes.left_m;
    out.right_mm = 1e3 * eyes.right_m;
  }
  const double half_depth =
      0.51 * plane.magnification * next.shown.fit * next.shown.view.zoom *
          std::max(glm::length(object.box.size()), beside.mesh ? glm::length(beside.box.size()) : 0.0) +
      1.0;
  out.front_mm = half_depth;
  out.back_mm = -half_depth;
  out.depth_factor = depth_factor(out);
  return out;
}

/// People's hands reach farther than a small object.
double Stage::Parts::depth_factor(const Observer& viewer) const {
  if (options.room.most_parallax_deg <= 0 || sink->traits().worn) return 1.0;
  double front = viewer.front_mm, back = viewer.back_mm;
  for (const LinesItem& lines : next.shown.before)
    for (const glm::dvec3& p : lines.points_mm) {
      front = std::max(front, p.z);
      back = std::min(back, p.z);
    }
  const double apart = glm::distance(options.viewer.left_mm, options.viewer.right_mm);
  return easy_depth_factor(eyes_before(sink->views(viewer), apart), front, back, options.room.most_parallax_deg);
}

Observer Stage::Parts::cameras(int half) const {
  Observer out = next.viewer;
  const SinkTraits traits = sink->traits();
  if (!next.shown.lens_zoom || traits.views > 1 || traits.worn) return out;
  // Who compares two states wants to see both from the same side, so that each has an eye before its own middle.
  const glm::dvec3 aside(next.shown.compared && !next.followed ? half_middle(half) : glm::dvec2(0.0), 0.0);
  for (glm::dvec3* const eye : {&out.left_mm, &out.right_mm, &out.nominal_mm})
    *eye = plane.aside_mm + aside + next.shown.view.zoom * (*eye - plane.aside_mm);
  return out;
}

Stage::Stage(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Stage::~Stage() = default;

Result<std::unique_ptr<Stage>> Stage::create(const TriMesh& mesh, const StageOptions& options,
                                             std::unique_ptr<OutputSink> sink) {
  if (!(options.room.margin >= 0 && options.room.margin <= 0.45) || options.samples < 1 || options.samples > 8)
    return fail(ErrorKind::kUsage, "view: margin {} and {} samples found, expected 0 to 0.45 and 1 to 8",
                options.room.margin, options.samples);
  auto parts = std::make_unique<Parts>(options);
  parts->next.shown.style = options.shading.style;
  parts->next.shown.other = options.shading.other;
  parts->next.shown.parts = options.shading.parts;
  DUBSAR_ASSIGN(parts->object, Parts::make_object(mesh, options));
  parts->sink = std::move(sink);
  if (!parts->sink) {
    DUBSAR_ASSIGN(parts->sink, options.catalog->make(options.display));
  }
  DUBSAR_TRY(parts->prepare(*parts->sink));
  return std::unique_ptr<Stage>(new Stage(std::move(parts)));
}

/// What there is to draw, in graphics memory; without a mesh nothing.
Result<Stage::Parts::Object> Stage::Parts::make_object(const TriMesh& mesh, const StageOptions& options) {
  Object object;
  object.source = &mesh;
  const bool later = options.subject == Subject::kLater && mesh.triangles.empty();
  if (later) object.box = {glm::dvec3(-kGroundMm), glm::dvec3(kGroundMm)};
  if (later || options.subject == Subject::kPattern || options.pictures) return object;
  DUBSAR_ASSIGN(PackedMesh packed, pack_mesh(mesh));
  if (packed.triangles_of(visible_partitions(options.shading.parts)) == 0)
    return fail(ErrorKind::kUsage, "view: none of the partitions asked for has triangles, so there is nothing to draw");
  object.box = packed.box_of(visible_partitions(options.shading.parts));
  DUBSAR_ASSIGN(object.mesh, make_levels(std::move(packed), options.quality));
  if (options.quality == Quality::kAdaptive) {
    DUBSAR_ASSIGN(object.multi, MultiView::create({.budget_ms = kMovingMs}));
  } else {
    DUBSAR_ASSIGN(object.renderer, Renderer::create());
  }
  return object;
}

Result<LodMesh> Stage::Parts::make_levels(PackedMesh packed, Quality quality) {
  return quality == Quality::kAdaptive ? LodMesh::growing(std::move(packed)) : LodMesh::exact(packed);
}

Result<void> Stage::set_mesh(const TriMesh& mesh) {
  DUBSAR_ASSIGN(Parts::Object object, Parts::make_object(mesh, parts_->options));
  std::swap(parts_->object, object);
  parts_->cost.exact_view_ms = 0.0;
  parts_->next.shown.marks = {};
  parts_->next.shown.compared.reset();
  parts_->beside = {};
  parts_->painted = {};
  return parts_->prepare(*parts_->sink);
}

std::optional<WearerFrame> Stage::wearer() const { return parts_->sink->wearer(); }
std::string Stage::display_note() const { return parts_->sink->note(); }
bool Stage::display_ended() const { return parts_->sink->ended(); }
void Stage::recentre() { parts_->sink->recentre(); }

Result<void> Stage::swap_eyes() {
  if (traits().worn) return fail(ErrorKind::kUnavailable, "display {} knows which eye is which", traits().name);
  if (traits().views != 2)
    return fail(ErrorKind::kUnavailable, "display {} has {} views, expected one with two to exchange the eyes",
                traits().name, traits().views);
  parts_->options.viewer.swap_eyes = !parts_->options.viewer.swap_eyes;
  return {};
}

SinkTraits Stage::traits() const { return parts_->sink->traits(); }
glm::dvec3 Stage::rest_m() const { return 1e-3 * (parts_->options.viewer.centre_mm() + parts_->plane.aside_mm); }
const Observer& Stage::viewer() const noexcept { return parts_->next.viewer; }
glm::dvec3 Stage::camera_mm() const { return parts_->cameras().centre_mm(); }
glm::dvec2 Stage::window_mm() const noexcept { return parts_->plane.window; }
const Box& Stage::box_mm() const noexcept { return parts_->object.box; }
glm::dvec2 Stage::middle_mm() const noexcept { return parts_->plane.middle; }

glm::dmat4 Stage::screen_from_model() const { return parts_->placed(); }

Result<void> Stage::set_display(const SinkSpec& spec) {
  DUBSAR_ASSIGN(auto sink, parts_->options.catalog->make(spec));
  DUBSAR_TRY(parts_->prepare(*sink));
  parts_->sink = std::move(sink);
  return {};
}

Result<void> Stage::set_screen(const Screen& screen) {
  if (screen == parts_->options.screen) return {};
  const Screen before = std::exchange(parts_->options.screen, screen);
  auto done = parts_->prepare(*parts_->sink);
  if (!done) {
    parts_->options.screen = before;
    static_cast<void>(parts_->sink->configure(before));
  }
  return done;
}

bool Stage::Parts::moved() const noexcept {
  if (sink->traits().worn) return true;
  if (!painted.of || !(painted.of->first == next.shown) || painted.of->second.swap_eyes != next.viewer.swap_eyes)
    return true;
  return glm::distance(painted.of->second.left_mm, next.viewer.left_mm) > kEyeStepMm ||
         glm::distance(painted.of->second.right_mm, next.viewer.right_mm) > kEyeStepMm;
}

void Stage::show(const Shown& shown, const FollowedEyes& eyes, TimestampNs now) {
  for (auto* const mesh : {&parts_->object.mesh, &parts_->beside.mesh})
    if (*mesh && !(*mesh)->complete() && parts_->painted.of) {  // the first picture has the machine for itself
      const auto updated = (*mesh)->update();
      if (!updated) log_warning("view: {}; it stays coarse", updated.error().message);
    }
  parts_->next.shown = shown;
  parts_->take_beside();
  parts_->next.now = now;
  parts_->cost.worked = false;
  parts_->next.viewer = parts_->viewer_at(eyes);
  parts_->next.followed = eyes.presence != Presence::kOff;
  if (!parts_->has_mesh()) return;
  const Shown& now_shown = parts_->next.shown;
  FieldNeeds needs = fields_needed(now_shown.style, now_shown.other), more;
  if (now_shown.compared) more = fields_needed(now_shown.compared->style, now_shown.compared->other);
  if (parts_->has_beside())
    parts_->measure(parts_->beside, more);
  else
    needs = needs.with(more);
  parts_->measure(parts_->object, needs);
}

bool Stage::moved() const noexcept { return parts_->moved(); }
const Shown& Stage::shown() const noexcept { return parts_->next.shown; }

bool Stage::needs_paint() const noexcept {
  const Parts& p = *parts_;
  return p.layers.overlay_changed || p.moved() || p.cost.refined || (p.may_refine() && !p.cost.worked);
}

/// Of a headset most of its period: what is late is shown twice, and the head has gone on meanwhile.
double Stage::Parts::budget_ms() const {
  constexpr double kOfPeriod = 0.75;  // the rest is the compositor's and the copy's
  const auto wearer = sink->wearer();
  return wearer && wearer->period > 0
             ? std::min(options.budget_ms, kOfPeriod * 1e-6 * static_cast<double>(wearer->period))
             : options.budget_ms;
}

void Stage::Parts::took(double ms, std::size_t count) {
  const double each = ms / static_cast<double>(std::max<std::size_t>(count, 1));
  cost.exact_view_ms = cost.exact_view_ms == 0.0 ? each : (1.0 - kForget) * cost.exact_view_ms + kForget * each;
}

/// New cameras: exact views where there is time for them.
Result<void> Stage::Parts::paint_moved() {
  const std::span<const View> wanted = sink->views(cameras());
  painted.views.assign(wanted.begin(), wanted.end());
  painted.of = {next.shown, next.viewer};
  if (sink->hidden()) return {};  // nobody sees it: the layers stay as they are
  painted.moved_at = next.now;
  cost.coarse = 0;
  cost.begun_ms = 0.0;
  if (!has_mesh()) return fill_layers();
  if (in_halves()) return paint_halves();
  set_scene();
  ViewArray& array = *layers.array;
  if (!object.multi) return object.renderer->render(scene(), painted.views, options.samples, array);
  // What is not known to be quick, and what another size may replace at once, is coarse first.
  if (!object.mesh->has_exact() || cost.exact_view_ms == 0.0 || next.now - cost.prepared_at < kRestNs ||
      cost.exact_view_ms * static_cast<double>(painted.views.size()) > budget_ms()) {
    cost.coarse = static_cast<int>(painted.views.size());
    return object.multi->draw_moving(scene(), painted.views, array);
  }
  const TimestampNs start = SteadyClock().now();
  DUBSAR_TRY(object.multi->draw_exact(scene(), painted.views, options.samples, array));
  glFinish();  // what it takes is to be known, and input that comes in meanwhile shall not wait behind it
  took(milliseconds_since(start), painted.views.size());
  return {};
}

Result<void> Stage::Parts::refine() {
  cost.worked = true;
  const TimestampNs start = SteadyClock().now();
  const int before = cost.coarse;
  const auto end = start + static_cast<TimestampNs>(1e6 * options.budget_ms);
  if (in_halves()) return refine_half(end);
  DUBSAR_ASSIGN(cost.coarse, object.multi->refine_until(end, scene(), painted.views, options.samples, *layers.array));
  cost.begun_ms += milliseconds_since(start);
  if (cost.coarse == before) return {};
  cost.refined = true;
  took(std::exchange(cost.begun_ms, 0.0), static_cast<std::size_t>(before - cost.coarse));
  return {};
}

Result<bool> Stage::work() {
  Parts& p = *parts_;
  if (p.moved() || !p.may_refine()) return false;
  DUBSAR_TRY(p.refine());
  return p.may_refine();
}

Result<void> Stage::paint(const Surface& target, Field field) {
  Parts& p = *parts_;
  if (p.sink->outdated()) DUBSAR_TRY(p.prepare(*p.sink));
  if (p.moved()) {
    DUBSAR_TRY(p.paint_moved());
  } else if (p.may_refine() && !p.cost.worked) {
    DUBSAR_TRY(p.refine());
  }
  p.cost.refined = false;
  Parts::Layers& layers = p.layers;
  if (layers.overlay != nullptr && p.sink->traits().worn) DUBSAR_TRY(p.paint_page());
  layers.overlay_changed = false;
  const bool over = layers.overlay != nullptr || p.overlay_marks.shown.any();
  if (!over || p.sink->traits().worn) return p.sink->compose(*layers.array, target, field);
  const ViewArray& array = *layers.array;
  if (!layers.overlaid) {
    DUBSAR_ASSIGN(layers.overlaid, ViewArray::create(array.width(), array.height(), array.layers()));
  }
  glCopyImageSubData(array.coded(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, layers.overlaid->coded(), GL_TEXTURE_2D_ARRAY, 0,
                     0, 0, 0, array.width(), array.height(), array.layers());
  DUBSAR_TRY(p.paint_overlay_marks(*layers.overlaid));
  if (layers.overlay != nullptr) DUBSAR_TRY(layers.overlay->paint(*layers.overlaid, p.plane.window));
  return p.sink->compose(*layers.overlaid, target, field);
}

std::optional<PanelLight> Stage::light() const { return parts_->sink->light(); }
int Stage::coarse_views() const noexcept { return parts_->cost.coarse; }

void Stage::set_overlay(LayerPainter* painter) {
  Parts::Layers& layers = parts_->layers;
  layers.overlay_changed = layers.overlay_changed || painter != nullptr || layers.overlay != nullptr;
  layers.overlay = painter;
  if (painter != nullptr) return;
  layers.overlaid.reset();
  layers.page.reset();
}

}  // namespace dubsar::app
