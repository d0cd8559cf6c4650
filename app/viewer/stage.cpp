#include "app/viewer/stage.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/budget.h"
#include "core/base/log.h"
#include "display/render/lod_mesh.h"
#include "display/render/multi_view.h"
#include "display/render/renderer.h"
#include "display/render/test_pattern.h"
#include "display/render/view_array.h"
#include "display/sinks/render_display.h"

namespace dubsar::app {
namespace {

constexpr std::uint64_t kBytesPerViewPixel = 4;
constexpr double kEyeStepMm = 0.05;           // what an eye may move before there is a new picture
constexpr TimestampNs kRestNs = 150'000'000;  // before coarse views are made exact
constexpr double kMovingMs = 28.0;            // for 30 pictures a second
constexpr double kForget = 0.3;               // of the mean time that a view takes

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
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(middle_mm + view.pan * window_height_mm, 0.0));
  const glm::dmat4 zoomed = glm::scale(glm::dmat4(1.0), glm::dvec3(view.zoom));
  return moved * zoomed * glm::mat4_cast(view.rotation) * place_object(box, direction, {0, 0, 0}, magnification);
}

struct Stage::Parts {
  StageOptions options;
  Box box;
  std::optional<LodMesh> mesh;
  std::optional<Renderer> renderer;  // kExact
  std::optional<MultiView> multi;    // kAdaptive
  std::unique_ptr<OutputSink> sink;
  std::optional<ViewArray> array, overlaid;
  LayerPainter* overlay = nullptr;
  bool overlay_changed = false;
  glm::dvec2 window{0.0}, middle{0.0};  // size and middle of what is shown of the panel's plane, mm
  glm::dvec3 aside_mm{0.0};             // from the panel's middle to where the eyes are thought to be level with
  double magnification = 1.0;
  Shown shown;  // of the next picture
  TimestampNs now = 0, moved_at = 0, prepared_at = 0;
  Viewer viewer;
  std::optional<std::pair<Shown, Viewer>> painted;
  std::vector<View> views;       // painted
  std::vector<DrawItem> items;   // painted
  std::vector<ClipPlane> clips;  // painted
  Light light;                   // painted
  std::vector<int> chosen;       // without a mesh: what each layer shows; empty: nothing yet
  int coarse = 0;
  double exact_view_ms = 0.0;  // what one exact view takes; 0: not known yet

  explicit Parts(const StageOptions& given) : options(given) {}
  Result<void> prepare(OutputSink& next);
  Viewer viewer_at(const FollowedEyes& eyes) const;
  glm::dmat4 placed() const {
    return app::screen_from_model(box, options.direction, shown.view, magnification * shown.fit, window.y, middle);
  }
  bool moved() const noexcept;
  SceneView scene() const { return {items, light, clips, options.shading.background, options.shading.fog}; }
  bool has_mesh() const noexcept { return !options.pattern && !options.pictures; }
  Result<void> fill_layers();
  Result<void> paint_moved();
  Result<void> refine();
  bool may_refine() const noexcept { return coarse > 0 && mesh->has_exact() && now - moved_at >= kRestNs; }
  void took(double ms, std::size_t count);
};

/// Configures a sink and makes the layers for it; nothing changes when that fails.
Result<void> Stage::Parts::prepare(OutputSink& next) {
  DUBSAR_TRY(next.configure(options.screen));
  const SinkTraits traits = next.traits();
  if (traits.stereo_visual && !options.stereo_window)
    return fail(ErrorKind::kUnavailable, "display {}: needs a window with a stereo visual", traits.name);
  DUBSAR_TRY(check_memory("display", kBytesPerViewPixel * static_cast<std::uint64_t>(traits.view.width) *
                                         static_cast<std::uint64_t>(traits.view.height) *
                                         static_cast<std::uint64_t>(traits.views)));
  DUBSAR_ASSIGN(ViewArray layers, ViewArray::create(traits.view.width, traits.view.height, traits.views));
  chosen.clear();
  if (array) exact_view_ms *= static_cast<double>(layers.width()) * layers.height() / array->width() / array->height();
  array = std::move(layers);
  overlaid.reset();
  painted.reset();
  coarse = 0;
  prepared_at = now;
  const ShownRect rect = shown_mm(next.views(Viewer())[0]);
  window = rect.size;
  middle = rect.middle;
  // A window on a plain monitor is looked at straight; before a panel of lenses people are where the panel wants them.
  aside_mm = traits.exact_pixels ? glm::dvec3(0.0) : glm::dvec3(middle, 0.0);
  // The longest edge fits both ways, so that every side of the object does.
  const glm::dvec3 size = box.size();
  magnification = options.magnification > 0 ? options.magnification
                                            : (1.0 - 2.0 * options.margin) * std::min(window.x, window.y) /
                                                  std::max({size.x, size.y, size.z, 1e-9});
  return {};
}

Viewer Stage::Parts::viewer_at(const FollowedEyes& eyes) const {
  Viewer out = options.viewer;
  out.left_mm += aside_mm;
  out.right_mm += aside_mm;
  out.nominal_mm += aside_mm;
  if (eyes.presence != Presence::kOff) {
    out.left_mm = 1e3 * eyes.left_m;
    out.right_mm = 1e3 * eyes.right_m;
  }
  const double half_depth = 0.51 * magnification * shown.fit * shown.view.zoom * glm::length(box.size()) + 1.0;
  out.front_mm = half_depth;
  out.back_mm = -half_depth;
  return out;
}

Stage::Stage(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Stage::~Stage() = default;

Result<std::unique_ptr<Stage>> Stage::create(const TriMesh& mesh, const StageOptions& options,
                                             std::unique_ptr<OutputSink> sink) {
  if (!(options.margin >= 0 && options.margin <= 0.45) || options.samples < 1 || options.samples > 8)
    return fail(ErrorKind::kUsage, "view: margin {} and {} samples found, expected 0 to 0.45 and 1 to 8",
                options.margin, options.samples);
  DUBSAR_ASSIGN(PackedMesh packed, pack_mesh(mesh));
  const bool has_mesh = !options.pattern && !options.pictures;
  if (has_mesh && packed.triangles_of(visible_partitions(options.shading.parts)) == 0)
    return fail(ErrorKind::kUsage, "view: none of the partitions asked for has triangles, so there is nothing to draw");
  auto parts = std::make_unique<Parts>(options);
  parts->shown = {{}, 1.0, options.shading.style, options.shading.parts};
  if (has_mesh) parts->box = packed.box_of(visible_partitions(options.shading.parts));
  if (!has_mesh) {
    // nothing to draw
  } else if (options.quality == Quality::kAdaptive) {
    DUBSAR_ASSIGN(parts->mesh, LodMesh::growing(std::move(packed)));
    DUBSAR_ASSIGN(parts->multi, MultiView::create({.budget_ms = kMovingMs}));
  } else {
    DUBSAR_ASSIGN(parts->mesh, LodMesh::exact(packed));
    DUBSAR_ASSIGN(parts->renderer, Renderer::create());
  }
  parts->sink = std::move(sink);
  if (!parts->sink) {
    DUBSAR_ASSIGN(parts->sink, options.catalog->make(options.display));
  }
  DUBSAR_TRY(parts->prepare(*parts->sink));
  return std::unique_ptr<Stage>(new Stage(std::move(parts)));
}

Result<void> Stage::swap_eyes() {
  if (traits().views != 2)
    return fail(ErrorKind::kUnavailable, "display {} has {} views, expected one with two to exchange the eyes",
                traits().name, traits().views);
  parts_->options.viewer.swap_eyes = !parts_->options.viewer.swap_eyes;
  return {};
}

SinkTraits Stage::traits() const { return parts_->sink->traits(); }
glm::dvec3 Stage::rest_m() const { return 1e-3 * (parts_->options.viewer.centre_mm() + parts_->aside_mm); }
const Viewer& Stage::viewer() const noexcept { return parts_->viewer; }
glm::dvec2 Stage::window_mm() const noexcept { return parts_->window; }
const Box& Stage::box_mm() const noexcept { return parts_->box; }
glm::dvec2 Stage::middle_mm() const noexcept { return parts_->middle; }

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
  if (!painted || !(painted->first == shown) || painted->second.swap_eyes != viewer.swap_eyes) return true;
  return glm::distance(painted->second.left_mm, viewer.left_mm) > kEyeStepMm ||
         glm::distance(painted->second.right_mm, viewer.right_mm) > kEyeStepMm;
}

void Stage::show(const Shown& shown, const FollowedEyes& eyes, TimestampNs now) {
  if (parts_->mesh && !parts_->mesh->complete()) {
    const auto updated = parts_->mesh->update();
    if (!updated) log_warning("view: {}; it stays coarse", updated.error().message);
  }
  parts_->shown = shown;
  parts_->now = now;
  parts_->viewer = parts_->viewer_at(eyes);
}

bool Stage::moved() const noexcept { return parts_->moved(); }
void Stage::repaint() { parts_->painted.reset(); }

bool Stage::needs_paint() const noexcept {
  const Parts& p = *parts_;
  return p.overlay_changed || p.moved() || p.may_refine();
}

void Stage::Parts::took(double ms, std::size_t count) {
  const double each = ms / static_cast<double>(std::max<std::size_t>(count, 1));
  exact_view_ms = exact_view_ms == 0.0 ? each : (1.0 - kForget) * exact_view_ms + kForget * each;
}

/// Pictures that exist already, where another one is wanted than is there.
Result<void> Stage::Parts::fill_layers() {
  const SinkTraits traits = sink->traits();
  chosen.resize(static_cast<std::size_t>(traits.views), -1);
  for (int layer = 0; layer < traits.views; ++layer) {
    int& there = chosen[static_cast<std::size_t>(layer)];
    const bool swapped = viewer.swap_eyes && traits.views == 2;
    const int wanted = options.pictures ? picture_for_layer(*options.pictures, traits, layer, viewer)
                       : swapped        ? 1 - layer
                                        : layer;
    if (std::exchange(there, wanted) == wanted) continue;
    DUBSAR_TRY(array->write_layer(
        layer, options.pictures ? layer_of_picture(options.pictures->views[static_cast<std::size_t>(wanted)],
                                                   options.pictures->aspect, traits, layer)
                                : numbered_view(traits.view.width, traits.view.height, wanted, traits.views)));
  }
  return {};
}

/// New cameras: exact views where there is time for them.
Result<void> Stage::Parts::paint_moved() {
  light = options.shading.light;
  light.azimuth_deg = shown.view.light_azimuth_deg;
  light.elevation_deg = shown.view.light_elevation_deg;
  const std::span<const View> wanted = sink->views(viewer);
  views.assign(wanted.begin(), wanted.end());
  painted = {shown, viewer};
  moved_at = now;
  coarse = 0;
  if (!has_mesh()) return fill_layers();
  clips = dubsar::moved(options.shading.clips, placed());
  items = {MeshItem{&*mesh, placed(), shown.style, shown.parts}};
  if (!multi) return renderer->render(scene(), views, options.samples, *array);
  // What is not known to be quick, and what another size may replace at once, is coarse first.
  if (!mesh->has_exact() || exact_view_ms == 0.0 || now - prepared_at < kRestNs ||
      exact_view_ms * static_cast<double>(views.size()) > options.budget_ms) {
    coarse = static_cast<int>(views.size());
    return multi->draw_moving(scene(), views, *array);
  }
  const TimestampNs start = SteadyClock().now();
  DUBSAR_TRY(multi->draw_exact(scene(), views, options.samples, *array));
  glFinish();  // what it takes is to be known, and input that comes in meanwhile shall not wait behind it
  took(milliseconds_since(start), views.size());
  return {};
}

Result<void> Stage::Parts::refine() {
  const TimestampNs start = SteadyClock().now();
  const int before = coarse;
  do {
    DUBSAR_ASSIGN(coarse, multi->refine(scene(), views, options.samples, *array, 1));
    glFinish();
  } while (coarse > 0 && milliseconds_since(start) < options.budget_ms);
  took(milliseconds_since(start), static_cast<std::size_t>(before - coarse));
  return {};
}

Result<void> Stage::paint(const Surface& target, Field field) {
  Parts& p = *parts_;
  if (p.moved()) {
    DUBSAR_TRY(p.paint_moved());
  } else if (p.may_refine()) {
    DUBSAR_TRY(p.refine());
  }
  p.overlay_changed = false;
  if (p.overlay == nullptr) return p.sink->compose(*p.array, target, field);
  const ViewArray& array = *p.array;
  if (!p.overlaid) {
    DUBSAR_ASSIGN(p.overlaid, ViewArray::create(array.width(), array.height(), array.layers()));
  }
  glCopyImageSubData(array.coded(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, p.overlaid->coded(), GL_TEXTURE_2D_ARRAY, 0, 0, 0,
                     0, array.width(), array.height(), array.layers());
  DUBSAR_TRY(p.overlay->paint(*p.overlaid, p.window));
  return p.sink->compose(*p.overlaid, target, field);
}

std::optional<PanelLight> Stage::light() const { return parts_->sink->light(); }
int Stage::coarse_views() const noexcept { return parts_->coarse; }

void Stage::set_overlay(LayerPainter* painter) {
  parts_->overlay_changed = parts_->overlay_changed || painter != nullptr || parts_->overlay != nullptr;
  parts_->overlay = painter;
  if (painter == nullptr) parts_->overlaid.reset();
}

}  // namespace dubsar::app
