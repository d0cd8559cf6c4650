#include "app/verbs/told_session.h"

#include <glm/geometric.hpp>

#include "app/verbs/view_files.h"
#include "app/viewer/first_document.h"
#include "app/viewer/run_view.h"

namespace dubsar::app {
namespace {

// A session whose steps are its only input ends 1 s after them (Viewer::over()): its turns until then, of which the
// first and the last one draw. A turn to another side has come to rest by then.
constexpr double kToldFps = 4.0;
constexpr int kToldTurns = 4;

CommandTable told_table() {
  std::vector<std::string> styles;
  for (const std::string_view name : shading_preset_names()) styles.emplace_back(name);
  return CommandTable::standard(styles);
}

}  // namespace

void add_do_option(Arguments& command, std::vector<std::string>& commands) {
  command
      .value("--do", commands,
             "a command of the window, as the palette (Ctrl+K) names it, e.g. \"unpack 100\"; may be given again, the "
             "next is done after it")
      .called("COMMAND");
}

Result<void> check_told(const std::vector<std::string>& commands) {
  const CommandTable table = told_table();
  for (const std::string& text : commands)
    if (const auto fits = table.check(text); !fits)
      return fail(ErrorKind::kUsage, "--do \"{}\": {}", text, fits.error().message);
  return {};
}

std::vector<TimedCommand> steps_of(const std::vector<std::string>& commands) {
  std::vector<TimedCommand> out;
  for (const std::string& text : commands) out.push_back({0.0, text});
  return out;
}

Screen screen_of(int width_px, int height_px) {
  Screen screen;
  screen.width_px = screen.window_w = width_px;
  screen.height_px = screen.window_h = height_px;
  screen.height_mm = screen.width_mm * height_px / width_px;
  return screen;
}

Result<ToldSession> tell_session(const TriMesh& mesh, ViewOptions view, const std::vector<std::string>& commands,
                                 ToldPart wanted, Progress& progress) {
  view.window.reset();
  view.inputs.clear();
  view.sources.beside = beside_reader(view, {.upright = view.work.upright});
  view.steps = steps_of(commands);
  view.around.notices = view.around.panels = false;
  view.time = {};
  view.time.fps = kToldFps;
  view.files = {};
  view.files.every = kToldTurns;
  DUBSAR_ASSIGN(view.mapping, default_mapping());
  ToldSession out;
  Result<void> read;
  const auto look = [&](const ViewMoment& moment) {
    if (wanted != ToldPart::kPicture || !moment.drawn || !read) return;
    auto image = moment.presenter.picture();
    if (!image) {
      read = tl::unexpected<Error>(std::move(image).error());
      return;
    }
    const Stage& stage = moment.viewer.stage();
    const SinkTraits traits = stage.traits();
    out.seen = {*std::move(image), traits.views, glm::length(glm::dvec3(stage.screen_from_model()[0])),
                traits.file_suffix, stage.light()};
  };
  DUBSAR_ASSIGN(ViewResult done, run_view(mesh, view, progress, look));
  DUBSAR_TRY(read);
  out.document = std::move(done.document);
  return out;
}

Result<void> dress_as_told(const TriMesh& mesh, const std::string& style, const std::vector<std::string>& commands,
                           Shading& shading, Progress& progress) {
  if (commands.empty()) return {};
  ViewOptions view;
  view.stage.screen = screen_of(64, 64);
  view.stage.shading = shading;
  view.work.document.style.name = view.stage.style = style;
  DUBSAR_ASSIGN(const ToldSession told, tell_session(mesh, view, commands, ToldPart::kDocument, progress));
  const Shown shown = shown_of(told.document, view_of(told.document), view.stage, surface_box(mesh));
  shading.style = shown.style;
  shading.other = shown.other;
  if (shown.light) shading.light = *shown.light;
  shading.light.azimuth_deg = told.document.light.azimuth_deg;
  shading.light.elevation_deg = told.document.light.elevation_deg;
  shading.parts = shown.parts;
  shading.clips.insert(shading.clips.end(), shown.clips.begin(), shown.clips.end());
  shading.fog = shown.fog;
  return {};
}

}  // namespace dubsar::app
