#include "tests/app/viewer/scripted_sessions.h"

#include <algorithm>

#include "core/base/progress.h"

namespace dubsar::testing {
namespace {
constexpr double kHalfIpdMm = 31.5;
}

Result<StagedSession> play(const XvfbServer& server, const TriMesh& mesh, const Stage& stage,
                           const std::vector<std::string>& inputs, const std::filesystem::path& record) {
  app::ViewOptions options;
  DUBSAR_ASSIGN(options.stage.display, parse_sink_spec(stage.display));
  options.stage.catalog = std::make_shared<SinkCatalog>(load_panels(stage.panel_folder));
  options.stage.samples = 2;
  DUBSAR_ASSIGN(options.mapping, default_mapping());
  DUBSAR_ASSIGN(options.stage.direction, parse_view_direction(stage.view));
  DUBSAR_ASSIGN(options.stage.shading, shading_preset("relief"));
  options.window = WindowOptions();
  options.window->width = stage.width;
  options.window->height = stage.height;
  options.window->x = 0;
  options.window->y = 0;
  options.window->decorated = false;
  options.fullscreen = false;
  options.around.notices = false;
  options.inputs = inputs;
  options.time.fps = stage.fps;
  options.files.every = stage.every;
  options.time.longest_s = stage.longest_s;
  options.files.record = record;
  SilentProgress progress;
  StagedSession out;
  int steps = 0;
  DUBSAR_ASSIGN(
      out.result, app::run_view(mesh, options, progress, [&](const app::ViewMoment& moment) {
        const double time_s = steps++ / stage.fps;
        if (!moment.drawn) return;
        static_cast<void>(moment.presenter.window()->screen());  // asks the server, so that it has done all before
        out.moments.push_back({time_s, server.screen(0, 0, stage.width, stage.height), moment.report});
      }));
  return out;
}

Image quilt_tile(const Image& quilt, int columns, int rows, int index) {
  const int width = quilt.width / columns, height = quilt.height / rows;
  const int left = index % columns * width, top = quilt.height - (index / columns + 1) * height;
  Image out(width, height, 3);
  for (int y = 0; y < height; ++y) std::copy_n(quilt.at(left, top + y), 3 * width, out.at(0, y));
  return out;
}

Result<SeenPair> seen_from(const SessionMoment& moment, const glm::dvec3& head_mm) {
  DisplayPicture picture{
      .image = moment.window, .views = 2, .magnification = 0.0, .file_suffix = {}, .light = moment.report.light};
  const glm::dvec3 half(kHalfIpdMm, 0.0, 0.0);
  SeenPair out;
  DUBSAR_ASSIGN(out.left, see_display(picture, head_mm - half));
  DUBSAR_ASSIGN(out.right, see_display(picture, head_mm + half));
  out.left_light = light_at(*moment.report.light, head_mm - half, 32);
  out.right_light = light_at(*moment.report.light, head_mm + half, 32);
  return out;
}

}  // namespace dubsar::testing
