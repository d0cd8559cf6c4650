// dubsar view FILE --display SINK --input SOURCE,...: a session in a window, or offscreen.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "app/calibration/display_choice.h"
#include "app/cli/config_folder.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/verbs/view_kiosk.h"
#include "core/base/atomic_file.h"
#include "core/base/log.h"
#include "core/base/parse_number.h"
#include "core/base/quantile.h"
#include "core/volume/import.h"
#include "devices/looking_glass/bridge_client.h"
#include "input/source_spec.h"

namespace dubsar::app {
namespace {

struct What {
  std::string in, scan, kiosk, view = "front", style = "relief";
  std::vector<std::string> partitions;
};

struct Panel {
  std::string display = "mono", size, monitor;
  std::vector<std::string> plugins;  // files
  int samples = 0, bridge_port = kBridgePort, ui_scale = 0;
  bool offscreen = false, fullscreen = false, windowed = false;
};

struct People {
  std::vector<std::string> inputs;
  std::string script, steps, mapping;
};

struct Made {
  std::string frames, record, tour;
  int every = 1;
};

struct Pace {
  double fps = 0.0, seconds = 0.0, display_delay_ms = 0.0;
};

struct Options {
  What what;
  Panel panel;
  People people;
  Made made;
  Pace time;
};

/// What --input and --script say, one text for each source.
Result<std::vector<std::string>> source_texts(const Options& options) {
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
  Screen screen;
  screen.width_px = screen.window_w = width;
  screen.height_px = screen.window_h = height;
  screen.height_mm = screen.width_mm * height / width;
  return screen;
}

nlohmann::json latency_json(const std::vector<double>& ms) {
  return {{"frames", ms.size()},
          {"median_ms", quantile(ms, 0.5)},
          {"p95_ms", quantile(ms, 0.95)},
          {"worst_ms", quantile(ms, 1.0)}};
}

nlohmann::json view_json(const ViewState& view) {
  return {{"rotation_wxyz", {view.rotation.w, view.rotation.x, view.rotation.y, view.rotation.z}},
          {"turned_deg", turn_between_deg(view.rotation, {1, 0, 0, 0})},
          {"zoom", view.zoom},
          {"pan", {view.pan.x, view.pan.y}},
          {"light_azimuth_deg", view.light_azimuth_deg},
          {"light_elevation_deg", view.light_elevation_deg}};
}

VerbResult describe(const std::string& display, const ViewResult& done, std::size_t triangles, bool simulated) {
  VerbResult out;
  const glm::dvec3 turn = vector_of(done.view.rotation) * 180.0 / 3.14159265358979323846;
  out.json = {{"display", display},
              {"frames", done.frames},
              {"pictures", done.written},
              {simulated ? "simulated_s" : "seconds", done.seconds},
              {"triangles", triangles},
              {"view", view_json(done.view)},
              {"largest_turn_in_a_frame_deg", done.largest_turn_deg},
              {simulated ? "input_age_at_cameras_simulated" : "input_age_at_cameras", latency_json(done.input_age_ms)},
              {"frame_cpu", latency_json(done.frame_cpu_ms)}};
  out.text = fmt::format(
      "{} frames of {:.1f} s, {} pictures\n"
      "turned by ({:.1f}, {:.1f}, {:.1f}) degrees about right, up, viewer; zoom {:.3f}; at most {:.2f} degrees a "
      "frame\n"
      "device time to cameras{}: median {:.1f} ms, 95 % {:.1f} ms, worst {:.1f} ms over {} frames with new input\n"
      "CPU time of a frame: median {:.1f} ms, worst {:.1f} ms\n",
      done.frames, done.seconds, done.written, turn.x, turn.y, turn.z, done.view.zoom, done.largest_turn_deg,
      simulated ? " (simulated clock)" : "", quantile(done.input_age_ms, 0.5), quantile(done.input_age_ms, 0.95),
      quantile(done.input_age_ms, 1.0), done.input_age_ms.size(), quantile(done.frame_cpu_ms, 0.5),
      quantile(done.frame_cpu_ms, 1.0));
  return out;
}

std::string_view health_name(SourceHealth health) {
  constexpr std::array<std::string_view, 4> kNames{"present", "lost", "missing", "off"};
  return kNames[static_cast<std::size_t>(health)];
}

void add_sources(const std::vector<SourceRow>& rows, VerbResult& out) {
  out.json["sources"] = nlohmann::json::array();
  for (const SourceRow& row : rows) {
    out.json["sources"].push_back({{"source", row.spec}, {"state", health_name(row.health)}, {"reason", row.reason}});
    out.text += fmt::format("source {}: {}{}{}\n", row.spec, health_name(row.health), row.reason.empty() ? "" : ", ",
                            row.reason);
  }
}

Result<ViewOptions> view_options(const Options& options) {
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
  if (!options.people.steps.empty()) {
    DUBSAR_ASSIGN(const std::string steps, read_text_file(options.people.steps));
    DUBSAR_ASSIGN(view.steps, parse_steps(steps, options.people.steps));
  }
  view.work.surface = options.what.in;
  view.around.scale = 0.01 * options.panel.ui_scale;
  view.work.scan = options.what.scan;
  view.time.fps = options.time.fps;
  view.time.longest_s = options.time.seconds;
  view.time.display_delay_s = 1e-3 * options.time.display_delay_ms;
  view.files.frames = options.made.frames;
  view.files.every = options.made.every;
  view.files.record = options.made.record;
  return view;
}

/// Whether the display can be what is asked for; --size is refused where it takes none of it.
Result<void> check_display(const Panel& panel, const Screen& screen, const StageOptions& stage) {
  DUBSAR_ASSIGN(const auto sink, stage.catalog->make(stage.display));
  DUBSAR_TRY(sink->configure(screen));
  if (!panel.size.empty() && sink->traits().own_pixels)
    return fail(ErrorKind::kUsage,
                "--size does nothing for display {}: its pixels are those of its panel or its layout",
                sink->traits().name);
  return {};
}

Result<void> without_window(const Options& options, ViewOptions& view) {
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

/// What a session that was killed left behind, and where this one keeps its own work.
void keep_work(const Options& options, ViewOptions& view) {
  std::error_code error;
  SourceFile source{std::filesystem::absolute(options.what.in, error).string(), 0};
  source.bytes = static_cast<std::int64_t>(std::filesystem::file_size(options.what.in, error));
  if (error) return;  // reading it says why
  view.work.document.source = source;
  const std::filesystem::path folder = session_folder();
  if (folder.empty()) return;
  view.files.autosave = Autosave::file_for(folder, source);
  const Autosave autosave(view.files.autosave);
  if (!autosave.has_left_behind()) return;
  auto left = autosave.left_behind(source);
  if (!left) return log_warning("{}", left.error().message);
  view.work.document = *std::move(left);
  view.work.upright = false;
  view.work.restored = true;
  log_info("view: the work of the last session on this file is here again");
}

Result<void> with_window(const Options& options, ViewOptions& view) {
  if (options.panel.fullscreen && options.panel.windowed)
    return fail(ErrorKind::kUsage, "--fullscreen and --windowed found, expected one of them");
  view.stage.quality = Quality::kAdaptive;
  view.stage.samples = options.panel.samples > 0 ? options.panel.samples : 2;
  view.window = WindowOptions();
  view.window->title = "dubsar: " + options.what.in;
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
  if (view.around.panels) view.stage.margin = 0.12;  // room for the line above the surface and the strip below it
  view.around.title = std::filesystem::path(options.what.in).filename().string();
  view.work.upright = options.what.view == "front";
  if (options.time.fps == 0) keep_work(options, view);
  DUBSAR_TRY(list_monitors());  // before a large file is read
  return {};
}

/// What the profile of a kiosk says takes the place of what was not given.
Options kiosk_options(Options options, const KioskProfile& profile, const KioskObject& object,
                      const std::string& display) {
  options.what.in = object.file.string();
  options.panel.display = display;
  options.what.style = object.style;
  if (options.people.inputs.empty()) options.people.inputs = profile.inputs;
  if (options.panel.monitor.empty() && !options.panel.offscreen) options.panel.monitor = profile.monitor;
  if (options.panel.size.empty() && !options.panel.windowed && !options.panel.offscreen)
    options.panel.fullscreen = true;
  return options;
}

Result<VerbResult> run_kiosk_of(const Options& given, Progress& progress) {
  if (!given.what.in.empty()) return fail(ErrorKind::kUsage, "view: a file and --kiosk found, expected one of them");
  const auto options = [&](const KioskProfile& profile, const KioskObject& object,
                           const std::string& display) -> Result<ViewOptions> {
    const Options one = kiosk_options(given, profile, object, display);
    DUBSAR_ASSIGN(ViewOptions view, view_options(one));
    if (one.people.mapping.empty()) {
      DUBSAR_ASSIGN(view.mapping, gallery_mapping());
    }
    DUBSAR_TRY(one.panel.offscreen ? without_window(one, view) : with_window(one, view));
    view.work.document.source = {};
    return view;
  };
  DUBSAR_ASSIGN(const KioskOutcome done, run_kiosk({given.what.kiosk, options}, progress));
  VerbResult out = describe(done.display, done.last, done.triangles, given.panel.offscreen || given.time.fps > 0);
  out.json["visits"] = done.counts.visits;
  out.json["resets"] = done.counts.resets;
  out.text += fmt::format("{} visits, {} times back to the beginning\n", done.counts.visits, done.counts.resets);
  add_sources(done.last.rows, out);
  return out;
}

Result<VerbResult> run(const Options& options, Progress& progress) {
  if (!options.what.kiosk.empty()) return run_kiosk_of(options, progress);
  if (options.what.in.empty())
    return fail(ErrorKind::kUsage, "view: no file found, expected a surface such as tablet.exa");
  DUBSAR_ASSIGN(ViewOptions view, view_options(options));
  if (options.made.tour.empty())
    DUBSAR_TRY(options.panel.offscreen ? without_window(options, view) : with_window(options, view));
  else
    view.work.upright = options.what.view == "front";
  if (!options.what.scan.empty()) {  // before a large file is read
    ImportOptions scan;
    scan.path = options.what.scan;
    DUBSAR_TRY(open_voxels(scan));
  }
  DUBSAR_ASSIGN(const TriMesh mesh, load_mesh({options.what.in, options.what.partitions, true}, progress));
  if (!options.made.tour.empty()) return write_tour(options.made.tour, mesh, view);
  if (!options.panel.offscreen) log_info("view: F1 shows help; Escape, closing the window or Ctrl-C end it");
  DUBSAR_ASSIGN(const ViewResult done, run_view(mesh, view, progress));
  VerbResult out = describe(options.panel.offscreen ? options.panel.display : done.display, done, mesh.triangles.size(),
                            view.time.fps > 0);
  if (!options.panel.offscreen) {
    out.json["frames_per_s_while_moving"] = done.fps;
    out.text += fmt::format("frames a second while things moved: {:.1f}\n", done.fps);
    out.json["intervals"] = latency_json(done.interval_ms);
    if (!done.interval_ms.empty())
      out.text += fmt::format(
          "from picture to picture while things moved, all {}: median {:.1f} ms, 95 % {:.1f} ms, longest {:.1f} ms\n",
          done.interval_ms.size(), quantile(done.interval_ms, 0.5), quantile(done.interval_ms, 0.95),
          quantile(done.interval_ms, 1.0));
  }
  add_sources(done.rows, out);
  return out;
}

}  // namespace

Verb add_view_verb(Arguments program) {
  auto options = std::make_shared<Options>();
  Arguments command = program.command("view", "turn a surface on a display with hands, head and mouse");
  command.reads("IN", options->what.in, "EXA, PLY, OBJ, STL or GLB file");
  command
      .reads("--kiosk", options->what.kiosk,
             "a gallery's profile (docs/kiosk.md): its objects, until an operator ends it")
      .called("PROFILE.json");
  command
      .reads("--scan", options->what.scan,
             "the scan that the surface was made of, for slices; else one of its name beside it")
      .called("SCAN.h5");
  std::string sinks, sources;
  for (const SinkBackend& sink : output_sinks()) sinks += (sinks.empty() ? "" : ", ") + std::string(sink.name);
  for (const std::string_view source : input_source_names())
    sources += (sources.empty() ? "" : ", ") + std::string(source);
  command.value("--display", options->panel.display, "NAME[:options]: " + sinks);
  command.value("--plugin", options->panel.plugins, "a display from a shared library; loading it runs its code")
      .called("FILE.so")
      .one_word_each_time();
  command.value("--input", options->people.inputs, "NAME[:options],...: " + sources);
  command.reads("--script", options->people.script, "simulated people: the same as --input scripted:FILE")
      .called("FILE");
  command
      .reads("--steps", options->people.steps,
             "commands with the seconds when they are said, one a line (docs/guide.md)")
      .called("FILE");
  command.reads("--mapping", options->people.mapping, "which gesture does what (docs/input.md)").called("FILE");
  command.flag("--offscreen", options->panel.offscreen, "without a window, in simulated time");
  command.value("--frames", options->made.frames, "folder for pictures of the frames").called("DIR");
  command.value("--every", options->made.every, "write only each N-th frame").range(1, 100000);
  command.writes("--record", options->made.record, FileFormat::kOther, "write the input for --input replay:FILE")
      .called("FILE");
  command
      .writes("--tour", options->made.tour, FileFormat::kOther,
              "write the tour of a gallery that this tablet has by itself, and end")
      .called("FILE");
  command.value("--size", options->panel.size,
                "WIDTHxHEIGHT of the window (1280x720; offscreen 960x540, or the panel's own)");
  command.value("--monitor", options->panel.monitor,
                "part of the name of the monitor to use (dubsar displays lists them)");
  command.flag("--fullscreen", options->panel.fullscreen,
               "cover the monitor; displays that need exact pixels do so by themselves");
  command.flag("--windowed", options->panel.windowed, "never cover the monitor");
  command
      .value("--fps", options->time.fps,
             "simulated time: N frames a second however long they take (offscreen 30; a window: real time)")
      .range(1.0, 240.0);
  command
      .value("--seconds", options->time.seconds,
             "end after this time at the latest (offscreen 60, a window stays open)")
      .range(0.1, 3600.0);
  command.value("--bridge-port", options->panel.bridge_port, "of Looking Glass Bridge, for panel auto").range(0, 65535);
  command
      .value("--display-delay-ms", options->time.display_delay_ms,
             "time from cameras to light, for the prediction of heads")
      .range(0.0, 100.0);
  command.value("--view", options->what.view, "the home view: front, back, left ... or orbit:AZIMUTH,ELEVATION[,ROLL]");
  command.value("--style", options->what.style, "shading, as of render");
  command.value("--partition", options->what.partitions, "only these parts: names or ids, e.g. tablet")
      .separated_by(',');
  command.value("--ui-scale", options->panel.ui_scale, "size of letters and panels in percent (as the desktop says)")
      .range(50, 400);
  command.value("--samples", options->panel.samples, "samples per pixel side (2; offscreen 1)").range(1, 8);
  command.footer(
      "In the window: F1 shows what mouse, keys and hands do and how the sources are; F2 goes to the next display, F11 "
      "covers\n"
      "the monitor, Escape ends.\n"
      "Examples:\n"
      "  dubsar view tablet.exa\n"
      "  dubsar view tablet.exa --display anaglyph --partition tablet\n"
      "  dubsar view tablet.exa --display lenticular:auto --input mouse,keyboard,leapc\n"
      "  dubsar view tablet.exa --offscreen --display quilt:looking-glass-portrait --script visitor.json --frames "
      "pictures\n"
      "  dubsar view tablet.exa --offscreen --display lenticular:spatiallabs-15.6 --script scholar.json --frames "
      "pictures --every 15");
  return {command, [options](const CommonOptions&, Progress& progress) { return run(*options, progress); }};
}

}  // namespace dubsar::app
