// dubsar view FILE --display SINK --input SOURCE,...: a session in a window, or offscreen.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "app/calibration/display_choice.h"
#include "app/cli/config_folder.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/cli/window_language.h"
#include "app/verbs/told_session.h"
#include "app/verbs/view_files.h"
#include "app/verbs/view_kiosk.h"
#include "app/verbs/view_outcome.h"
#include "app/verbs/view_panels.h"
#include "app/verbs/view_request.h"
#include "core/base/files/atomic_file.h"
#include "core/base/system/log.h"
#include "core/base/text/parse_number.h"
#include "input/source_spec.h"

namespace dubsar::app {
namespace {

/// What --input and --script say, one text for each source.
Result<std::vector<std::string>> source_texts(const ViewRequest& options) {
  const std::vector<std::string_view> names = input_source_names();
  std::vector<std::string> out;
  for (const std::string& text : options.people.inputs) {
    DUBSAR_ASSIGN(const std::vector<SourceSpec> specs, parse_sources(text, names));
    for (const SourceSpec& spec : specs) out.push_back(spec.text());
  }
  if (!options.people.script.empty()) out.push_back(SourceSpec{"scripted", {{"path", options.people.script}}}.text());
  return out;
}

Result<Screen> parse_screen(const std::string& text) {
  const auto [width, height] = parse_size(text).value_or(std::array{0, 0});
  if (width < 16 || height < 16 || width > 16384 || height > 16384)
    return fail(ErrorKind::kUsage,
                "--size \"{}\" not understood, expected WIDTHxHEIGHT of 16 to 16384 pixels such as 960x540", text);
  return screen_of(width, height);
}

Result<void> add_panels(const ViewRequest& options, ViewOptions& view) {
  for (const std::string& text : options.panel.also) {
    DUBSAR_ASSIGN(const AskedPanel asked, parse_asked_panel(text));
    if (options.panel.offscreen && !asked.monitor.empty())
      return fail(ErrorKind::kUsage, "--also {}: a monitor is for windows, expected no --offscreen", text);
    DUBSAR_ASSIGN(SidePanelOptions panel, side_panel(asked, options.panel.plugins, options.panel.bridge_port));
    view.also.push_back(std::move(panel));
  }
  return {};
}

/// Those of a kiosk: one that cannot be is said, and the others are shown.
void add_panels(const ViewRequest& options, const KioskProfile& profile, ViewOptions& view) {
  for (const KioskPanel& panel : profile.panels) {
    const AskedPanel asked{panel.display, options.panel.offscreen ? std::string() : panel.monitor, panel.size};
    auto made = side_panel(asked, options.panel.plugins, options.panel.bridge_port);
    if (made) {
      view.also.push_back(*std::move(made));
      continue;
    }
    SidePanelOptions missing;
    missing.name = panel.display;
    missing.window.monitor = asked.monitor;
    missing.problem = made.error().message;
    view.also.push_back(std::move(missing));
  }
}

Result<ViewOptions> view_options(const ViewRequest& options) {
  ViewOptions view;
  DUBSAR_ASSIGN(DisplayChoice choice,
                choose_display(options.panel.display, options.panel.plugins, options.panel.bridge_port));
  view.stage.display = std::move(choice.display);
  view.stage.catalog = std::move(choice.catalog);
  DUBSAR_ASSIGN(view.stage.shading, shading_preset(options.what.style));
  view.work.document.style.name = view.stage.style = options.what.style;
  DUBSAR_ASSIGN(view.stage.direction, parse_view_direction(options.what.view));
  view.sources.model_folder = model_folder();
  if (options.people.mapping.empty()) {
    DUBSAR_ASSIGN(view.mapping, default_mapping());
  } else {
    DUBSAR_ASSIGN(const std::string text, read_text_file(options.people.mapping));
    DUBSAR_ASSIGN(view.mapping, parse_mapping(text, options.people.mapping));
  }
  DUBSAR_ASSIGN(view.inputs, source_texts(options));
  DUBSAR_TRY(check_record(options.made.record, view.inputs));
  DUBSAR_TRY(add_panels(options, view));
  if (!options.people.steps.empty()) {
    DUBSAR_ASSIGN(const std::string steps, read_text_file(options.people.steps));
    DUBSAR_ASSIGN(view.steps, parse_steps(steps, options.people.steps));
  }
  view.around.scale = 0.01 * options.panel.ui_scale;
  view.time.fps = options.time.fps;
  view.time.longest_s = options.time.seconds;
  view.time.display_delay_s = 1e-3 * options.time.display_delay_ms;
  view.files.frames = options.made.frames;
  DUBSAR_TRY(check_frames(options.made.frames));
  view.files.every = options.made.every;
  view.files.record = options.made.record;
  return view;
}

/// Whether the display can be what is asked for; --size is refused where it takes none of it.
Result<void> check_display(const ViewRequest::Panel& panel, const Screen& screen, const StageOptions& stage) {
  DUBSAR_ASSIGN(const auto sink, stage.catalog->make(stage.display));
  DUBSAR_TRY(sink->configure(screen));
  if (!panel.size.empty() && sink->traits().own_pixels)
    return fail(ErrorKind::kUsage,
                "--size does nothing for display {}: its pixels are those of its panel or its layout",
                sink->traits().name);
  return {};
}

Result<void> without_window(const ViewRequest& options, ViewOptions& view) {
  if (!options.panel.monitor.empty() || options.panel.fullscreen || options.panel.windowed)
    return fail(ErrorKind::kUsage, "--monitor, --fullscreen and --windowed are for windows, expected no --offscreen");
  DUBSAR_ASSIGN(view.stage.screen, parse_screen(options.panel.size.empty() ? "960x540" : options.panel.size));
  DUBSAR_TRY(check_display(options.panel, view.stage.screen, view.stage));
  view.stage.samples = std::max(1, options.panel.samples);
  view.around.notices = false;
  if (options.time.fps == 0) view.time.fps = 30.0;
  if (options.time.seconds == 0) view.time.longest_s = 60.0;
  return {};
}

Result<void> with_window(const ViewRequest& options, ViewOptions& view) {
  if (options.panel.fullscreen && options.panel.windowed)
    return fail(ErrorKind::kUsage, "--fullscreen and --windowed found, expected one of them");
  view.stage.quality = Quality::kAdaptive;
  view.stage.samples = options.panel.samples > 0 ? options.panel.samples : 2;
  view.window = WindowOptions();
  view.window->title = options.what.in.empty() ? "dubsar" : "dubsar: " + options.what.in.front();
  view.window->monitor = options.panel.monitor;
  if (!options.panel.size.empty()) {
    DUBSAR_ASSIGN(const Screen screen, parse_screen(options.panel.size));
    DUBSAR_TRY(check_display(options.panel, screen, view.stage));
    view.window->width = screen.window_w;
    view.window->height = screen.window_h;
  }
  if (options.panel.fullscreen || options.panel.windowed || !options.panel.size.empty())
    view.fullscreen = options.panel.fullscreen;
  view.around.notices = view.around.panels = options.made.frames.empty();
  if (view.around.panels) view.stage.room.margin = 0.12;  // room for the line above the surface and the strip below it
  DUBSAR_TRY(list_monitors());                            // before a large file is read
  return {};
}

/// What the profile of a kiosk says takes the place of what was not given.
ViewRequest kiosk_options(ViewRequest options, const KioskProfile& profile, const KioskObject& object,
                          const std::string& display) {
  options.what.in = {object.file.string()};
  options.panel.display = display;
  options.what.style = object.style;
  if (options.people.inputs.empty()) options.people.inputs = profile.inputs;
  if (options.panel.monitor.empty() && !options.panel.offscreen) options.panel.monitor = profile.monitor;
  options.panel.plugins.insert(options.panel.plugins.end(), profile.plugins.begin(), profile.plugins.end());
  if (options.panel.size.empty() && !options.panel.windowed && !options.panel.offscreen)
    options.panel.fullscreen = true;
  return options;
}

Result<VerbResult> run_kiosk_of(const ViewRequest& given, Progress& progress) {
  if (!given.what.in.empty()) return fail(ErrorKind::kUsage, "view: a file and --kiosk found, expected one of them");
  const auto options = [&](const KioskProfile& profile, const KioskObject& object,
                           const std::string& display) -> Result<ViewOptions> {
    const ViewRequest one = kiosk_options(given, profile, object, display);
    DUBSAR_ASSIGN(ViewOptions view, view_options(one));
    if (one.people.mapping.empty()) {
      DUBSAR_ASSIGN(view.mapping, gallery_mapping());
    }
    DUBSAR_TRY(one.panel.offscreen ? without_window(one, view) : with_window(one, view));
    add_panels(one, profile, view);
    view.work.upright = one.what.view == "front";
    view.work.surface = object.file;
    view.around.title = object.file.filename().string();
    return view;
  };
  DUBSAR_ASSIGN(const KioskOutcome done, run_kiosk({given.what.kiosk, options}, progress));
  if (done.stopped) return describe_stopped(done);
  VerbResult out =
      describe_session(done.display, done.last, done.triangles, given.panel.offscreen || given.time.fps > 0);
  out.json.update({{"visits", done.counts.visits}, {"resets", done.counts.resets}});
  out.text += fmt::format("{} visits, {} times back to the beginning\n", done.counts.visits, done.counts.resets);
  add_sources(done.last.rows, out);
  add_panel_states(done.last, out);
  return out;
}

FileReading file_reading(const ViewRequest& options, const std::optional<ImportOptions>& scan) {
  const bool window = !options.panel.offscreen;
  return {options.what.partitions, mesh_unit_mm(options.what.unit).value_or(0.0), scan, options.what.view == "front",
          window && options.time.fps == 0};
}

/// What can be wrong with files is known before a large one is read.
Result<void> check_files(const ViewRequest& options) {
  if (const auto unit = mesh_unit_mm(options.what.unit); !unit) return tl::unexpected<Error>(unit.error());
  const ViewRequest::What& what = options.what;
  if (what.in.empty() && (options.panel.offscreen || options.time.fps > 0 || !options.made.tour.empty()))
    return fail(ErrorKind::kUsage, "view: no file found, expected a surface such as tablet.exa");
  if (what.in.size() > 1 && !what.scan.empty())
    return fail(ErrorKind::kUsage, "view: {} files and one --scan found, expected one file with it", what.in.size());
  return {};
}

/// Those that can be shown as far as that is known before they are read. Of several in a window the others are told and
/// left out; else the first that cannot be is an error.
Result<std::vector<std::filesystem::path>> good_files(const ViewRequest& options, bool live) {
  std::vector<std::filesystem::path> out;
  std::optional<Error> wrong;
  std::vector<std::string> told;
  for (const std::string& file : options.what.in) {
    const auto done = check_surface(file, options.what.partitions);
    if (done) {
      out.emplace_back(file);
      continue;
    }
    if (!wrong) wrong = done.error();
    told.push_back(done.error().message);
  }
  if (wrong && (!live || out.empty())) return tl::unexpected<Error>(*std::move(wrong));
  for (const std::string& sentence : told) log_warning("{}; it is left out", sentence);
  return out;
}

Result<VerbResult> run(const ViewRequest& options, Progress& progress) {
  DUBSAR_TRY(choose_language(options.panel.language, !options.panel.offscreen && options.time.fps == 0));
  if (!options.what.kiosk.empty()) return run_kiosk_of(options, progress);
  DUBSAR_ASSIGN(ViewOptions view, view_options(options));
  if (options.made.tour.empty())
    DUBSAR_TRY(options.panel.offscreen ? without_window(options, view) : with_window(options, view));
  DUBSAR_TRY(check_files(options));
  DUBSAR_ASSIGN(const std::optional<ImportOptions> scan,
                asked_scan(options.what.scan, options.what.scan_reading, options.what.in));
  const bool live = !options.panel.offscreen && options.time.fps == 0;
  DUBSAR_ASSIGN(const auto files, good_files(options, live && options.made.tour.empty()));
  if (!options.made.tour.empty()) {
    view.work.upright = options.what.view == "front";
    view.work.surface = options.what.in.front();
    const MeshRequest asked{files.front(), options.what.partitions, true, {*mesh_unit_mm(options.what.unit)}, true};
    DUBSAR_ASSIGN(const TriMesh mesh, load_mesh(asked, progress));
    return write_tour(options.made.tour, mesh, view);
  }
  view.sources.beside = beside_reader(view, file_reading(options, scan));
  FileLoader loader(surface_reader(view, file_reading(options, scan)), live ? recent_list() : std::filesystem::path());
  OpenedSurface first;
  if (live) {  // the window is there before what it shows
    DUBSAR_TRY(loader.open(files));
    log_info("view: F1 shows help; Escape, closing the window or Ctrl-C end it");
  } else {
    DUBSAR_ASSIGN(first, surface_reader(view, file_reading(options, scan))(files.front(), progress, {}));
    loader.has(files);
    view.work = first.work;
    view.around.title = first.title;
  }
  DUBSAR_ASSIGN(const ViewResult done, run_view(first.mesh, view, progress, {}, &loader));
  keep_language();
  VerbResult out = describe_session(options.panel.offscreen ? options.panel.display : done.display, done,
                                    done.triangles, view.time.fps > 0);
  if (!options.panel.offscreen) add_intervals(done, out);
  add_sources(done.rows, out);
  add_panel_states(done, out);
  return out;
}

}  // namespace

Verb add_view_verb(Arguments program) {
  auto options = std::make_shared<ViewRequest>();
  return {add_view_arguments(program, *options),
          [options](const CommonOptions&, Progress& progress) { return run(*options, progress); }};
}

}  // namespace dubsar::app
