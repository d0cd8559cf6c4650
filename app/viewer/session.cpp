#include "app/viewer/session.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <mutex>

#include "core/base/budget.h"
#include "display/render/lod_mesh.h"
#include "display/render/multi_view.h"
#include "display/render/renderer.h"
#include "display/render/test_pattern.h"
#include "display/render/view_array.h"
#include "display/sinks/render_display.h"
#include "input/navigation/navigation.h"

namespace dubsar::app {
namespace {

constexpr std::uint64_t kBytesPerViewPixel = 4;
constexpr double kEyeStepMm = 0.05;           // what an eye may move before there is a new picture
constexpr TimestampNs kRestNs = 150'000'000;  // before coarse views are made exact
constexpr double kForget = 0.3;               // of the mean time that a view takes

bool same(const ViewState& a, const ViewState& b) {
  return a.rotation == b.rotation && a.zoom == b.zoom && a.pan == b.pan && a.light_azimuth_deg == b.light_azimuth_deg &&
         a.light_elevation_deg == b.light_elevation_deg;
}

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

struct Session::Parts {
  SessionOptions options;
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
  InputMixer mixer;
  std::function<void(TimestampNs, const InputFrame&)> told;
  std::mutex steering;  // for the five below, and for writing `seen`, which sources look at while they are polled
  Navigator navigator;
  HeadFollower head;
  TimestampNs steered = 0, newest_input = 0;
  std::optional<glm::dvec3> selected_m;  // since the last poll()
  ViewState seen;
  TimestampNs used_input = 0;
  TimestampNs now = 0, moved_at = 0, prepared_at = 0;
  Viewer viewer;  // of the last poll()
  std::optional<std::pair<ViewState, Viewer>> painted;
  std::vector<View> views;      // painted
  std::vector<DrawItem> items;  // painted
  Light light;                  // painted
  int coarse = 0;
  double exact_view_ms = 0.0;  // what one exact view takes; 0: not known yet

  explicit Parts(const SessionOptions& given)
      : options(given), navigator(given.mapping, home(given)), head(follow(given)), seen(navigator.view()) {}

  static ViewState home(const SessionOptions& options) {
    ViewState view;
    view.light_azimuth_deg = options.shading.light.azimuth_deg;
    view.light_elevation_deg = options.shading.light.elevation_deg;
    return view;
  }
  static HeadFollowOptions follow(const SessionOptions& options) {
    HeadFollowOptions out;
    out.rest_m = 1e-3 * options.viewer.centre_mm();
    out.ipd_m = 1e-3 * glm::length(options.viewer.right_mm - options.viewer.left_mm);
    return out;
  }
  void steer(TimestampNs now);  // `steering` is held
  Result<void> prepare(OutputSink& next);
  Viewer viewer_at(const FollowedEyes& eyes) const;
  bool moved() const;
  SceneView scene() const { return {items, light, {}, options.shading.background}; }
  Result<void> paint_moved();
  Result<void> refine();
  void took(double ms, std::size_t count);
};

/// Configures a sink and makes the layers for it; nothing changes when that fails.
Result<void> Session::Parts::prepare(OutputSink& next) {
  DUBSAR_TRY(next.configure(options.screen));
  const SinkTraits traits = next.traits();
  if (traits.stereo_visual && !options.stereo_window)
    return fail(ErrorKind::kUnavailable, "display {}: needs a window with a stereo visual", traits.name);
  DUBSAR_TRY(check_memory("display", kBytesPerViewPixel * static_cast<std::uint64_t>(traits.view.width) *
                                         static_cast<std::uint64_t>(traits.view.height) *
                                         static_cast<std::uint64_t>(traits.views)));
  DUBSAR_ASSIGN(ViewArray layers, ViewArray::create(traits.view.width, traits.view.height, traits.views));
  if (options.pattern)
    for (int i = 0; i < traits.views; ++i)
      DUBSAR_TRY(layers.write_layer(i, numbered_view(traits.view.width, traits.view.height, i, traits.views)));
  if (array) exact_view_ms *= static_cast<double>(layers.width()) * layers.height() / array->width() / array->height();
  array = std::move(layers);
  overlaid.reset();
  painted.reset();
  coarse = 0;
  prepared_at = now;
  const ShownRect shown = shown_mm(next.views(Viewer())[0]);
  window = shown.size;
  middle = shown.middle;
  // A window on a plain monitor is looked at straight; before a panel of lenses people are where the panel wants them.
  aside_mm = traits.exact_pixels ? glm::dvec3(0.0) : glm::dvec3(middle, 0.0);
  const std::scoped_lock lock(steering);
  head.set_rest(1e-3 * (options.viewer.centre_mm() + aside_mm));
  // The longest edge fits both ways, so that every side of the object does.
  const glm::dvec3 size = box.size();
  magnification = options.magnification > 0 ? options.magnification
                                            : (1.0 - 2.0 * options.margin) * std::min(window.x, window.y) /
                                                  std::max({size.x, size.y, size.z, 1e-9});
  return {};
}

Viewer Session::Parts::viewer_at(const FollowedEyes& eyes) const {
  Viewer out = options.viewer;
  out.left_mm += aside_mm;
  out.right_mm += aside_mm;
  out.nominal_mm += aside_mm;
  if (eyes.presence != Presence::kOff) {
    out.left_mm = 1e3 * eyes.left_m;
    out.right_mm = 1e3 * eyes.right_m;
  }
  const double half_depth = 0.51 * magnification * seen.zoom * glm::length(box.size()) + 1.0;
  out.front_mm = half_depth;
  out.back_mm = -half_depth;
  return out;
}

Session::Session(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::create(const TriMesh& mesh, const SessionOptions& options,
                                                 std::unique_ptr<OutputSink> sink) {
  if (!(options.margin >= 0 && options.margin <= 0.45) || options.samples < 1 || options.samples > 8)
    return fail(ErrorKind::kUsage, "view: margin {} and {} samples found, expected 0 to 0.45 and 1 to 8",
                options.margin, options.samples);
  DUBSAR_ASSIGN(PackedMesh packed, pack_mesh(mesh));
  if (!options.pattern && packed.triangles_of(visible_partitions(options.shading.parts)) == 0)
    return fail(ErrorKind::kUsage, "view: none of the partitions asked for has triangles, so there is nothing to draw");
  auto parts = std::make_unique<Parts>(options);
  if (!options.pattern) parts->box = packed.box_of(visible_partitions(options.shading.parts));
  if (options.pattern) {
    // nothing to draw
  } else if (options.quality == Quality::kAdaptive) {
    DUBSAR_ASSIGN(parts->mesh, LodMesh::with_levels(std::move(packed)));
    DUBSAR_ASSIGN(parts->multi, MultiView::create());
  } else {
    DUBSAR_ASSIGN(parts->mesh, LodMesh::exact(packed));
    DUBSAR_ASSIGN(parts->renderer, Renderer::create());
  }
  parts->sink = std::move(sink);
  if (!parts->sink) {
    DUBSAR_ASSIGN(parts->sink, options.catalog->make(options.display));
  }
  DUBSAR_TRY(parts->prepare(*parts->sink));
  return std::unique_ptr<Session>(new Session(std::move(parts)));
}

InputMixer& Session::input() noexcept { return parts_->mixer; }
SinkTraits Session::traits() const { return parts_->sink->traits(); }
const ViewState& Session::view() const noexcept { return parts_->seen; }

Result<void> Session::set_display(const SinkSpec& spec) {
  DUBSAR_ASSIGN(auto sink, parts_->options.catalog->make(spec));
  DUBSAR_TRY(parts_->prepare(*sink));
  parts_->sink = std::move(sink);
  return {};
}

Result<void> Session::set_screen(const Screen& screen) {
  if (screen == parts_->options.screen) return {};
  const Screen before = std::exchange(parts_->options.screen, screen);
  auto done = parts_->prepare(*parts_->sink);
  if (!done) {
    parts_->options.screen = before;
    static_cast<void>(parts_->sink->configure(before));
  }
  return done;
}

bool Session::Parts::moved() const {
  if (!painted || !same(painted->first, seen)) return true;
  return glm::distance(painted->second.left_mm, viewer.left_mm) > kEyeStepMm ||
         glm::distance(painted->second.right_mm, viewer.right_mm) > kEyeStepMm;
}

void Session::on_input(std::function<void(TimestampNs, const InputFrame&)> told) {
  const std::scoped_lock lock(parts_->steering);
  parts_->told = std::move(told);
}

void Session::Parts::steer(TimestampNs at) {
  steered = std::max(steered, at);  // two threads may have read the clock in the other order
  const InputFrame& frame = mixer.poll(steered);
  if (told) told(steered, frame);
  navigator.update(steered, frame);
  if (navigator.kept_head()) head.add(*navigator.kept_head(), steered);
  if (navigator.selected_m()) selected_m = navigator.selected_m();
  newest_input = std::max(newest_input, frame.time);
}

void Session::steer(TimestampNs now) {
  const std::scoped_lock lock(parts_->steering);
  parts_->steer(now);
}

FrameReport Session::poll(TimestampNs now, TimestampNs display_time) {
  Parts& p = *parts_;
  FrameReport report;
  const std::scoped_lock lock(p.steering);
  p.steer(now);
  p.now = now;
  p.seen = p.navigator.view();
  const FollowedEyes eyes = p.head.eyes(now, display_time);
  p.viewer = p.viewer_at(eyes);
  report.view = p.seen;
  report.viewer = p.viewer;
  report.head = eyes.presence;
  report.control = p.navigator.control();
  report.selected_m = std::exchange(p.selected_m, std::nullopt);
  report.moving = p.moved();
  if (p.newest_input > p.used_input) {
    report.input_age = now - p.newest_input;
    p.used_input = p.newest_input;
  }
  return report;
}

bool Session::needs_paint() const noexcept {
  const Parts& p = *parts_;
  return p.overlay_changed || p.moved() || (p.coarse > 0 && p.now - p.moved_at >= kRestNs);
}

void Session::Parts::took(double ms, std::size_t count) {
  const double each = ms / static_cast<double>(std::max<std::size_t>(count, 1));
  exact_view_ms = exact_view_ms == 0.0 ? each : (1.0 - kForget) * exact_view_ms + kForget * each;
}

/// New cameras: exact views where there is time for them.
Result<void> Session::Parts::paint_moved() {
  light = options.shading.light;
  light.azimuth_deg = seen.light_azimuth_deg;
  light.elevation_deg = seen.light_elevation_deg;
  const glm::dmat4 placed = screen_from_model(box, options.direction, seen, magnification, window.y, middle);
  const std::span<const View> wanted = sink->views(viewer);
  views.assign(wanted.begin(), wanted.end());
  painted = {seen, viewer};
  moved_at = now;
  coarse = 0;
  if (options.pattern) return {};
  items = {MeshItem{&*mesh, placed, options.shading.style, options.shading.parts}};
  if (!multi) return renderer->render(scene(), views, options.samples, *array);
  // What is not known to be quick, and what another size may replace at once, is coarse first.
  if (exact_view_ms == 0.0 || now - prepared_at < kRestNs ||
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

Result<void> Session::Parts::refine() {
  const TimestampNs start = SteadyClock().now();
  const int before = coarse;
  do {
    DUBSAR_ASSIGN(coarse, multi->refine(scene(), views, options.samples, *array, 1));
    glFinish();
  } while (coarse > 0 && milliseconds_since(start) < options.budget_ms);
  took(milliseconds_since(start), static_cast<std::size_t>(before - coarse));
  return {};
}

Result<void> Session::paint(const Surface& target, Field field) {
  Parts& p = *parts_;
  if (p.moved()) {
    DUBSAR_TRY(p.paint_moved());
  } else if (p.coarse > 0 && p.now - p.moved_at >= kRestNs) {
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

std::optional<PanelLight> Session::light() const { return parts_->sink->light(); }
int Session::coarse_views() const noexcept { return parts_->coarse; }

void Session::set_overlay(LayerPainter* painter) {
  parts_->overlay_changed = parts_->overlay_changed || painter != nullptr || parts_->overlay != nullptr;
  parts_->overlay = painter;
  if (painter == nullptr) parts_->overlaid.reset();
}

Result<FrameReport> Session::draw(TimestampNs now, TimestampNs display_time, const Surface& target, Field field) {
  FrameReport report = poll(now, display_time);
  parts_->painted.reset();
  DUBSAR_TRY(paint(target, field));
  report.light = light();
  return report;
}

}  // namespace dubsar::app
