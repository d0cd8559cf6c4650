#include "app/session/session.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/budget.h"
#include "display/gpu_mesh.h"
#include "display/render_display.h"
#include "display/renderer.h"
#include "display/view_array.h"
#include "input/navigation.h"

namespace dubsar::app {
namespace {

constexpr std::uint64_t kBytesPerViewPixel = 4;

/// Width and height in mm of what a view shows of the panel's plane.
glm::dvec2 window_mm(const View& view) {
  const auto ndc = [&](const glm::dvec3& p) {
    const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(p, 1.0);
    return glm::dvec2(clip) / clip.w;
  };
  const glm::dvec2 origin = ndc({0, 0, 0});
  return {2.0 / (ndc({1, 0, 0}) - origin).x, 2.0 / (ndc({0, 1, 0}) - origin).y};
}

}  // namespace

glm::dmat4 screen_from_model(const Box& box, const ViewDirection& direction, const ViewState& view, double magnification,
                             double window_height_mm) {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(view.pan * window_height_mm, 0.0));
  const glm::dmat4 zoomed = glm::scale(glm::dmat4(1.0), glm::dvec3(view.zoom));
  return moved * zoomed * glm::mat4_cast(view.rotation) * place_object(box, direction, {0, 0, 0}, magnification);
}

struct Session::Parts {
  SessionOptions options;
  Box box;
  GpuMesh mesh;
  std::optional<Renderer> renderer;
  std::unique_ptr<OutputSink> sink;
  std::optional<ViewArray> array;
  glm::dvec2 window{0.0};
  double magnification = 1.0;
  InputMixer mixer;
  Navigator navigator;
  HeadFollower head;
  ViewState seen;
  InputFrame last_input;
  TimestampNs newest_input = -1;

  explicit Parts(const SessionOptions& given)
      : options(given), navigator(given.mapping, home(given)), head(follow(given)), seen(navigator.view()) {}

  static ViewState home(const SessionOptions& options) {
    ViewState view;
    view.light_azimuth_deg = options.shading.light_azimuth_deg;
    view.light_elevation_deg = options.shading.light_elevation_deg;
    return view;
  }
  static HeadFollowOptions follow(const SessionOptions& options) {
    HeadFollowOptions out;
    out.rest_m = 1e-3 * options.viewer.centre_mm();
    out.ipd_m = 1e-3 * glm::length(options.viewer.right_mm - options.viewer.left_mm);
    return out;
  }
  Result<void> prepare(OutputSink& next);
  Viewer viewer_at(const FollowedEyes& eyes) const;
};

/// Configures a sink and makes the layers for it; nothing changes when that fails.
Result<void> Session::Parts::prepare(OutputSink& next) {
  DUBSAR_TRY(next.configure(options.screen));
  const SinkTraits traits = next.traits();
  if (traits.stereo_visual)
    return fail(ErrorKind::kUnavailable, "display {}: needs a window with a stereo visual", traits.name);
  DUBSAR_TRY(check_memory("display", kBytesPerViewPixel * static_cast<std::uint64_t>(traits.view.width) *
                                         static_cast<std::uint64_t>(traits.view.height) * static_cast<std::uint64_t>(traits.views)));
  DUBSAR_ASSIGN(ViewArray layers, ViewArray::create(traits.view.width, traits.view.height, traits.views));
  array = std::move(layers);
  window = window_mm(next.views(Viewer())[0]);
  // The longest edge fits both ways, so that every side of the object does.
  const glm::dvec3 size = box.size();
  magnification = (1.0 - 2.0 * options.margin) * std::min(window.x, window.y) / std::max({size.x, size.y, size.z, 1e-9});
  return {};
}

Viewer Session::Parts::viewer_at(const FollowedEyes& eyes) const {
  Viewer viewer = options.viewer;
  if (eyes.presence != Presence::kOff) {
    viewer.left_mm = 1e3 * eyes.left_m;
    viewer.right_mm = 1e3 * eyes.right_m;
  }
  const double half_depth = 0.51 * magnification * seen.zoom * glm::length(box.size()) + 1.0;
  viewer.front_mm = half_depth;
  viewer.back_mm = -half_depth;
  return viewer;
}

Session::Session(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::create(const TriMesh& mesh, const SessionOptions& options) {
  if (!(options.margin >= 0 && options.margin <= 0.45) || options.samples < 1 || options.samples > 8)
    return fail(ErrorKind::kUsage, "view: margin {} and {} samples found, expected 0 to 0.45 and 1 to 8", options.margin, options.samples);
  DUBSAR_ASSIGN(const PackedMesh packed, pack_mesh(mesh));
  if (packed.triangles_of(options.shading.partitions) == 0)
    return fail(ErrorKind::kUsage, "view: none of the partitions asked for has triangles, so there is nothing to draw");
  auto parts = std::make_unique<Parts>(options);
  parts->box = packed.box_of(options.shading.partitions);
  DUBSAR_ASSIGN(parts->mesh, GpuMesh::upload(packed));
  DUBSAR_ASSIGN(parts->renderer, Renderer::create());
  DUBSAR_ASSIGN(parts->sink, make_sink(options.display, options.profile_folder));
  DUBSAR_TRY(parts->prepare(*parts->sink));
  return std::unique_ptr<Session>(new Session(std::move(parts)));
}

InputMixer& Session::input() noexcept { return parts_->mixer; }
SinkTraits Session::traits() const { return parts_->sink->traits(); }
const ViewState& Session::view() const noexcept { return parts_->seen; }
const InputFrame& Session::last_input() const noexcept { return parts_->last_input; }

Result<void> Session::set_display(std::string_view spec) {
  DUBSAR_ASSIGN(auto sink, make_sink(spec, parts_->options.profile_folder));
  DUBSAR_TRY(parts_->prepare(*sink));
  parts_->sink = std::move(sink);
  return {};
}

Result<void> Session::set_screen(const Screen& screen) {
  const Screen before = std::exchange(parts_->options.screen, screen);
  auto done = parts_->prepare(*parts_->sink);
  if (!done) {
    parts_->options.screen = before;
    static_cast<void>(parts_->sink->configure(before));
  }
  return done;
}

Result<FrameReport> Session::draw(TimestampNs now, TimestampNs display_time, const Surface& target) {
  Parts& p = *parts_;
  FrameReport report;
  p.last_input = p.mixer.poll(now);
  p.navigator.update(now, p.last_input);
  p.seen = p.navigator.view();
  if (p.navigator.kept_head()) p.head.add(*p.navigator.kept_head());
  const FollowedEyes eyes = p.head.eyes(now, display_time);
  report.view = p.seen;
  report.viewer = p.viewer_at(eyes);
  report.head = eyes.presence;
  report.control = p.navigator.control();
  report.selected_m = p.navigator.selected_m();
  if (p.last_input.time > p.newest_input) {
    report.input_age = now - p.last_input.time;
    p.newest_input = p.last_input.time;
  }
  Shading shading = p.options.shading;
  shading.light_azimuth_deg = p.seen.light_azimuth_deg;
  shading.light_elevation_deg = p.seen.light_elevation_deg;
  const glm::dmat4 placed = screen_from_model(p.box, p.options.direction, p.seen, p.magnification, p.window.y);
  const std::span<const View> wanted = p.sink->views(report.viewer);
  std::vector<View> views(wanted.begin(), wanted.end());
  for (View& view : views) view.view_from_world = view.view_from_world * placed;
  DUBSAR_TRY(p.renderer->render(p.mesh, shading, views, p.options.samples, *p.array));
  DUBSAR_TRY(p.sink->compose(*p.array, target));
  report.light = p.sink->light();
  return report;
}

}  // namespace dubsar::app
