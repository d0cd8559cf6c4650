#include "display/sinks/render_display.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "core/base/system/budget.h"
#include "display/render/context/context_egl.h"
#include "display/render/images/test_pattern.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/passes/compose_pass.h"
#include "display/render/renderer.h"
#include "display/render/view_array.h"

namespace dubsar {
namespace {

constexpr std::uint64_t kBytesPerViewPixel = 4;
constexpr double kDepthMargin = 0.02;  // of the object's depth, before and behind it

/// Sizes of the object in the picture: width, height, depth.
glm::dvec3 picture_extents(const Box& box, const ViewDirection& direction) {
  const ObjectFrame frame = picture_frame(object_frame(box), direction);
  const glm::dvec3 size = box.size();
  const auto along = [&](const glm::dvec3& axis) { return glm::dot(glm::abs(axis), size); };
  return {along(frame.right), along(frame.up), along(frame.front)};
}

/// Width and height in mm of what a view shows of the panel's plane.
glm::dvec2 window_mm(const View& view) {
  const auto ndc = [&](const glm::dvec3& p) {
    const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(p, 1.0);
    return glm::dvec2(clip) / clip.w;
  };
  const glm::dvec2 origin = ndc({0, 0, 0});
  return {2.0 / (ndc({1, 0, 0}) - origin).x, 2.0 / (ndc({0, 1, 0}) - origin).y};
}

struct Stage {  // destroyed from the bottom to the top: the sink's GL objects go before the context
  std::unique_ptr<EglContext> context;
  std::unique_ptr<OutputSink> sink;
};

Result<Stage> open_stage(const SinkSpec& display, const DisplayOptions& options) {
  Stage stage;
  DUBSAR_ASSIGN(stage.context, EglContext::create());
  DUBSAR_ASSIGN(stage.sink, options.catalog->make(display));
  DUBSAR_TRY(stage.sink->configure(options.screen));
  const SinkTraits traits = stage.sink->traits();
  if (traits.stereo_visual)
    return fail(ErrorKind::kUnavailable,
                "display {}: needs a window with a stereo visual, expected a display that makes one picture",
                traits.name);
  if (traits.fields > 1)
    return fail(
        ErrorKind::kUsage,
        "display {}: shows its eyes one after the other, expected a window, or a display that makes one picture "
        "such as side_by_side",
        traits.name);
  if (traits.worn)
    return fail(ErrorKind::kUsage, "display {}: is worn and shows what is there now, expected dubsar view",
                traits.name);
  DUBSAR_TRY(check_memory("display", kBytesPerViewPixel * static_cast<std::uint64_t>(traits.view.width) *
                                         static_cast<std::uint64_t>(traits.view.height) *
                                         static_cast<std::uint64_t>(traits.views)));
  return stage;
}

Result<DisplayPicture> compose_picture(const Stage& stage, const ViewArray& array) {
  const SinkTraits traits = stage.sink->traits();
  DisplayPicture out;
  out.views = traits.views;
  out.file_suffix = traits.file_suffix;
  DUBSAR_ASSIGN(const OffscreenSurface surface, OffscreenSurface::create(traits.output));
  DUBSAR_TRY(stage.sink->compose(array, surface.surface()));
  DUBSAR_ASSIGN(out.image, surface.read());
  out.light = stage.sink->light();
  return out;
}

}  // namespace

glm::dmat4 place_object(const Box& box, const ViewDirection& direction, const glm::dvec3& place_mm,
                        double magnification) {
  const ObjectFrame frame = picture_frame(object_frame(box), direction);
  const std::array<glm::dvec3, 3> rows{frame.right, frame.up, frame.front};
  glm::dmat4 out(1.0);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out[c][r] = magnification * rows[static_cast<std::size_t>(r)][c];
    out[3][r] = place_mm[r] - magnification * glm::dot(rows[static_cast<std::size_t>(r)], box.centre());
  }
  return out;
}

Result<DisplayPicture> render_display(const TriMesh& mesh, const SinkSpec& display, const DisplayOptions& options,
                                      Progress& progress) {
  if (!(options.magnification >= 0) || !std::isfinite(options.magnification) ||
      !(options.margin >= 0 && options.margin <= 0.45))
    return fail(ErrorKind::kUsage,
                "display: magnification {} and margin {} found, expected above 0 (or 0 to fit) and 0 to 0.45",
                options.magnification, options.margin);
  DUBSAR_ASSIGN(const PackedMesh packed, pack_mesh(mesh));
  if (packed.triangles_of(visible_partitions(options.shading.parts)) == 0)
    return fail(ErrorKind::kUsage,
                "display: none of the partitions asked for has triangles, so there is nothing to draw");
  DUBSAR_ASSIGN(const Stage stage, open_stage(display, options));
  const SinkTraits traits = stage.sink->traits();

  DUBSAR_ASSIGN(LodMesh gpu, LodMesh::exact(packed));
  const Box box = scene_box_mm(MeshScene(gpu, options.shading));
  const glm::dvec3 extents = picture_extents(box, options.direction);
  double magnification = options.magnification;
  if (magnification == 0) {
    const glm::dvec2 window = window_mm(stage.sink->views(Observer())[0]) * (1.0 - 2.0 * options.margin);
    magnification = std::min(window.x / std::max(extents.x, 1e-9), window.y / std::max(extents.y, 1e-9));
  }
  Observer viewer = options.viewer;
  const double half_depth = (0.5 + kDepthMargin) * magnification * extents.z + 1.0;
  viewer.front_mm = options.place_mm.z + half_depth;
  viewer.back_mm = options.place_mm.z - half_depth;
  const glm::dmat4 screen_from_model = place_object(box, options.direction, options.place_mm, magnification);

  DUBSAR_TRY(carry_fields(gpu, mesh, fields_needed(options.shading.style, options.shading.other), progress));
  const MeshScene scene(gpu, options.shading, screen_from_model);
  DUBSAR_ASSIGN(Renderer renderer, Renderer::create());
  DUBSAR_ASSIGN(ViewArray array, ViewArray::create(traits.view.width, traits.view.height, traits.views));
  const std::span<const View> views = stage.sink->views(viewer);
  progress.begin("render", traits.views, "view");
  for (int i = 0; i < traits.views; ++i) {
    if (progress.cancelled()) return cancelled_error();
    DUBSAR_TRY(renderer.render(scene, views.subspan(static_cast<std::size_t>(i), 1), options.samples, array, i));
    progress.advance(1);
  }
  DUBSAR_ASSIGN(DisplayPicture out, compose_picture(stage, array));
  out.magnification = magnification;
  progress.end();
  return out;
}

Result<DisplayPicture> render_pattern(const SinkSpec& display, const DisplayOptions& options) {
  DUBSAR_ASSIGN(const Stage stage, open_stage(display, options));
  const SinkTraits traits = stage.sink->traits();
  DUBSAR_ASSIGN(ViewArray array, ViewArray::create(traits.view.width, traits.view.height, traits.views));
  stage.sink->views(options.viewer);
  for (int i = 0; i < traits.views; ++i)
    DUBSAR_TRY(array.write_layer(i, numbered_view(traits.view.width, traits.view.height, i, traits.views)));
  return compose_picture(stage, array);
}

Result<DisplayPicture> show_pictures(const ViewPictures& pictures, const SinkSpec& display,
                                     const DisplayOptions& options) {
  DUBSAR_ASSIGN(const Stage stage, open_stage(display, options));
  const SinkTraits traits = stage.sink->traits();
  DUBSAR_ASSIGN(ViewArray array, ViewArray::create(traits.view.width, traits.view.height, traits.views));
  stage.sink->views(options.viewer);
  DUBSAR_TRY(write_pictures(pictures, traits, options.viewer, array));
  return compose_picture(stage, array);
}

Result<Image> see_display(const DisplayPicture& picture, const glm::dvec3& eye_mm) {
  if (!picture.light)
    return fail(
        ErrorKind::kUsage,
        "display: this display has no lenses, so every eye sees its picture as it is; expected display lenticular");
  if (!std::isfinite(glm::dot(eye_mm, eye_mm)) || eye_mm.z < kNearestEyeMm)
    return fail(ErrorKind::kUsage,
                "display: an eye at {}, {}, {} mm found, expected one at least {} mm before the panel (third number)",
                eye_mm.x, eye_mm.y, eye_mm.z, kNearestEyeMm);
  const TrackedPanel& panel = picture.light->panel;
  if (picture.image.width != panel.width_px || picture.image.height != panel.height_px)
    return fail(ErrorKind::kUsage, "display: a picture of {} x {} pixels found, expected the whole panel of {} x {}",
                picture.image.width, picture.image.height, panel.width_px, panel.height_px);
  return see(picture.image, panel, eye_mm);
}

}  // namespace dubsar
