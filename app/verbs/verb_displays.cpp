// dubsar displays: what there is to show pictures on, what belongs to what, and why something is missing.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/calibration/adjust_window.h"
#include "app/calibration/calibration_search.h"
#include "app/calibration/display_choice.h"
#include "app/calibration/eye_check.h"
#include "app/cli/config_folder.h"
#include "app/cli/verb.h"
#include "app/viewer/run_view.h"
#include "core/base/system/log.h"
#include "devices/looking_glass/bridge_client.h"
#include "display/panels/crosstalk_curve.h"
#include "display/panels/edid.h"
#include "display/panels/panel_adjust.h"
#include "display/panels/panel_set.h"
#include "display/render/context/context_glfw.h"
#include "display/sinks/catalog/plugin_sink.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

struct DisplaysRequest {
  std::vector<std::string> adjust;  ///< PANEL, figures or "reset"
  bool window = false;              ///< adjust by eye
  std::string monitor;
  std::string calibration, crosstalk, check_eyes, input = "head:opentrack";
  double seconds = 10.0, delay_ms = 40.0;
  bool of_check = false;  ///< an option of --check-eyes was given
  std::string edids = "/sys/class/drm";
  int bridge_port = kBridgePort;
  std::vector<std::string> plugins;
};

const char* kind_name(PanelKind kind) {
  return kind == PanelKind::kLookingGlass ? "looking_glass" : kind == PanelKind::kLensSheet ? "lens_sheet" : "tracked";
}

void add_sinks(const SinkCatalog& catalog, const DisplaysRequest& options, VerbResult& result) {
  result.text += "displays (--display NAME[:options])\n";
  for (const SinkBackend& sink : output_sinks()) {
    result.json["displays"].push_back({{"name", sink.name}, {"summary", sink.summary}});
    result.text += fmt::format("  {:<14} {}\n", sink.name, sink.summary);
  }
  for (std::size_t i = 0; i < catalog.plugins().size(); ++i) {
    const auto& plugin = catalog.plugins()[i];
    const std::string& file = options.plugins[i];
    result.json["displays"].push_back({{"name", plugin->name()}, {"summary", plugin->summary()}, {"plugin", file}});
    result.text += fmt::format("  {:<14} {} ({})\n", plugin->name(), plugin->summary(), file);
  }
}

void add_panels(const PanelSet& panels, VerbResult& result) {
  result.text += "panels (--display lenticular:PANEL, quilt:PANEL)\n";
  for (const PanelProfile& p : panels.profiles) {
    nlohmann::json entry{{"name", p.name},
                         {"title", p.title},
                         {"kind", kind_name(p.kind)},
                         {"width_px", p.width_px},
                         {"height_px", p.height_px},
                         {"views", p.views},
                         {"lens_figures", p.sheet.has_value() || p.optics.has_value()},
                         {"note", p.note}};
    if (p.lenses.adjustment.pitch) entry["adjusted"]["pitch"] = *p.lenses.adjustment.pitch;
    if (p.lenses.adjustment.slope) entry["adjusted"]["slope"] = *p.lenses.adjustment.slope;
    if (p.lenses.adjustment.center) entry["adjusted"]["center"] = *p.lenses.adjustment.center;
    result.json["panels"].push_back(std::move(entry));
    result.text += fmt::format("  {:<32} {}x{}, {} views{}{}\n", p.name, p.width_px, p.height_px, p.views,
                               p.sheet || p.optics ? "" : "; no lens figures, give calibration=FILE",
                               p.lenses.adjustment.empty() ? "" : "; adjusted by you");
  }
  result.json["panel_problems"] = nlohmann::json::array();
  for (const PanelProblem& problem : panels.problems) {
    result.json["panel_problems"].push_back(
        {{"file", problem.file.string()}, {"panel", problem.panel}, {"reason", problem.reason}});
    result.text += fmt::format("  left out: {}\n", problem.reason);
  }
}

Result<void> add_calibrations(const DisplaysRequest& options, const PanelSet& panels, VerbResult& result) {
  result.json["calibrations"] = nlohmann::json::array();
  result.text += "calibrations of Looking Glass units\n";
  const SteadyClock clock;
  CalibrationSearch search = search_this_machine(options.bridge_port, clock);
  search.file = options.calibration;
  if (std::error_code error; !options.calibration.empty() && !fs::exists(options.calibration, error))
    return fail(ErrorKind::kNoInput, "--calibration {}: there is no such file", options.calibration);
  const CalibrationReport report = find_calibrations(search, panels, clock);
  for (const FoundCalibration& found : report.found) {
    // One that somebody named is expected to be good; others are told.
    if (found.route == "file" && !found.panel)
      result.failure = Error{ErrorKind::kConfig, fmt::format("--calibration {}: {}", found.place, found.problem)};
    nlohmann::json entry{{"route", found.route}, {"place", found.place}};
    if (!found.serial.empty()) entry["serial"] = found.serial;
    if (found.panel)
      entry["panel"] = found.panel->name;
    else
      entry["problem"] = found.problem;
    result.json["calibrations"].push_back(std::move(entry));
    result.text += fmt::format("  {:<14} {}: {}\n", found.route, found.place,
                               found.panel ? fmt::format("{} (serial {})", found.panel->name,
                                                         found.serial.empty() ? "not given" : found.serial)
                                           : found.problem);
  }
  for (const auto& [route, why] : report.missing) {
    result.json["calibrations_missing"][route] = why;
    result.text += fmt::format("  {:<14} none: {}\n", route, why);
  }
  return {};
}

nlohmann::json edid_json(const Edid& edid) {
  return {{"manufacturer", edid.manufacturer},
          {"product", edid.product},
          {"name", edid.name},
          {"serial", edid.serial},
          {"width_px", edid.width_px},
          {"height_px", edid.height_px},
          {"width_mm", edid.width_mm},
          {"height_mm", edid.height_mm}};
}

/// Which panel a monitor is, by its EDID.
std::string add_identity(const Edid& edid, const Monitor& monitor, const PanelSet& panels, nlohmann::json& entry) {
  entry["edid"] = edid_json(edid);
  std::string words =
      fmt::format("; {} {} {}", edid.manufacturer, edid.product, edid.name.empty() ? "without a name" : edid.name);
  entry["panels"] = nlohmann::json::array();
  for (const PanelProfile* panel : panels_of_edid(panels, edid)) {
    words += (entry["panels"].empty() ? ": " : " or ") + panel->name;
    entry["panels"].push_back(panel->name);
  }
  const bool own_mode = monitor.width_px == edid.width_px && monitor.height_px == edid.height_px;
  if (!entry["panels"].empty() && !own_mode)
    words += fmt::format(" (runs at {}x{}: a panel with lenses needs its own {}x{})", monitor.width_px,
                         monitor.height_px, edid.width_px, edid.height_px);
  return words;
}

void add_monitors(const DisplaysRequest& options, const PanelSet& panels, VerbResult& result) {
  result.json["monitors"] = nlohmann::json::array();
  result.text += "monitors\n";
  const std::vector<ConnectedEdid> edids = read_connected_edids(options.edids);
  result.json["edids"] = nlohmann::json::array();
  for (const ConnectedEdid& each : edids) {
    nlohmann::json entry = each.edid ? edid_json(*each.edid) : nlohmann::json{{"problem", each.edid.error().message}};
    entry["connector"] = each.connector;
    for (const PanelProfile* panel :
         each.edid ? panels_of_edid(panels, *each.edid) : std::vector<const PanelProfile*>())
      entry["panels"].push_back(panel->name);
    result.json["edids"].push_back(std::move(entry));
    result.text +=
        fmt::format("  {:<14} EDID {}\n", each.connector,
                    each.edid ? fmt::format("{} {} {}", each.edid->manufacturer, each.edid->product, each.edid->name)
                              : each.edid.error().message);
  }
  const auto monitors = list_monitors();
  if (!monitors) {
    result.json["monitors_missing"] = monitors.error().message;
    result.text += fmt::format("  none: {}\n", monitors.error().message);
    return;
  }
  for (const Monitor& m : *monitors) {
    nlohmann::json entry{{"name", m.name},
                         {"x", m.x},
                         {"y", m.y},
                         {"width_px", m.width_px},
                         {"height_px", m.height_px},
                         {"width_mm", m.width_mm},
                         {"height_mm", m.height_mm},
                         {"refresh_hz", m.refresh_hz},
                         {"primary", m.primary}};
    std::string words;
    if (const Edid* const edid = edid_of(m, edids); edid != nullptr)
      words = add_identity(*edid, m, panels, entry);
    else
      words = "; no EDID of it was found";
    result.json["monitors"].push_back(std::move(entry));
    result.text +=
        fmt::format("  {:<14} {}x{} pixels at {},{}, {:.0f}x{:.0f} mm, {:.0f} Hz{}{}\n", m.name, m.width_px,
                    m.height_px, m.x, m.y, m.width_mm, m.height_mm, m.refresh_hz, m.primary ? ", primary" : "", words);
  }
}

/// The optical simulator's curves of a tracked panel.
Result<VerbResult> crosstalk(const std::string& panel) {
  DUBSAR_ASSIGN(const PanelProfile profile, load_panels(panel_folder()).find(panel));
  DUBSAR_ASSIGN(const CrosstalkCurve curve, crosstalk_curve(profile));
  VerbResult result;
  result.json = {{"panel", profile.name},
                 {"eye_distance_mm", curve.eye_distance_mm},
                 {"design_distance_mm", curve.design_distance_mm},
                 {"nominal_percent", 100 * curve.nominal},
                 {"worst_sideways_percent", 100 * curve.worst_sideways}};
  result.text = fmt::format(
      "panel {}: light of the wrong eye at {:g} mm, eyes {:g} mm apart\n  woven for the true eyes {:.1f} %, anywhere "
      "{:g} mm to either side {:.1f} %\n",
      profile.name, curve.design_distance_mm, curve.eye_distance_mm, 100 * curve.nominal, curve.eye_distance_mm,
      100 * curve.worst_sideways);
  result.text += "woven for where the head was: head speed down, latency across\n  mm/s  ";
  const double first_speed = curve.lags.front().head_mm_s;
  for (const auto& lag : curve.lags)
    if (lag.head_mm_s == first_speed) result.text += fmt::format("{:>7g} ms", lag.latency_ms);
  double speed = -1.0;
  for (const auto& lag : curve.lags) {
    if (lag.head_mm_s != speed) result.text += fmt::format("\n  {:<6g}", speed = lag.head_mm_s);
    result.text += fmt::format("{:>8.1f} %", 100 * lag.wrong);
    result.json["lags"].push_back({{"head_mm_s", lag.head_mm_s},
                                   {"latency_ms", lag.latency_ms},
                                   {"moved_mm", lag.moved_mm},
                                   {"percent", 100 * lag.wrong}});
  }
  result.text += "\nwoven for the true eyes at other places: exact refraction, and the paraxial approximation\n";
  for (const auto& place : curve.places) {
    result.text += fmt::format("  ({:g}, {:g}, {:g}) mm  {:>5.1f} %  {:>5.1f} %\n", place.head_mm.x, place.head_mm.y,
                               place.head_mm.z, 100 * place.exact, 100 * place.paraxial);
    result.json["places"].push_back({{"head_mm", {place.head_mm.x, place.head_mm.y, place.head_mm.z}},
                                     {"exact_percent", 100 * place.exact},
                                     {"paraxial_percent", 100 * place.paraxial}});
  }
  return result;
}

/// A tracker before a tracked panel, while somebody moves.
Result<VerbResult> check_tracker(const DisplaysRequest& options, Progress& progress) {
  DUBSAR_ASSIGN(const PanelProfile panel, load_panels(panel_folder()).find(options.check_eyes));
  DUBSAR_ASSIGN(const auto source, make_input(options.input));
  const auto told = [](const std::string& line) { log_info("{}", line); };
  DUBSAR_ASSIGN(const EyeCheckFigures figures,
                check_eyes(*source, panel, {options.seconds, options.delay_ms}, told, progress));
  VerbResult result;
  const auto triple = [](const glm::dvec3& p) { return nlohmann::json{p.x, p.y, p.z}; };
  result.json = {{"panel", panel.name},
                 {"input", options.input},
                 {"samples", figures.samples},
                 {"rate_hz", figures.rate_hz},
                 {"delay_ms", options.delay_ms},
                 {"median_percent", figures.median_percent},
                 {"worst_percent", figures.worst_percent},
                 {"own_percent", figures.own_percent},
                 {"left_mm", triple(figures.last_mm.left_mm)},
                 {"right_mm", triple(figures.last_mm.right_mm)},
                 {"note", figures.note}};
  result.text = fmt::format(
      "{} before panel {}: {} heads, {:.0f} a second; light of the wrong eye with {:g} ms of delay: median {:.1f} %, "
      "worst "
      "{:.1f} %; of the lenses alone {:.1f} %\n",
      options.input, panel.name, figures.samples, figures.rate_hz, options.delay_ms, figures.median_percent,
      figures.worst_percent, figures.own_percent);
  return result;
}

Result<VerbResult> adjust_in_window(const DisplaysRequest& options, Progress& progress) {
  const fs::path folder = panel_folder();
  if (options.adjust.size() != 1)
    return fail(ErrorKind::kUsage, "--adjust: figures and --window found, expected one of them");
  if (folder.empty())
    return fail(ErrorKind::kCannotCreate, "cannot save the adjustment: neither XDG_CONFIG_HOME nor HOME is set");
  ViewOptions view;
  view.window = WindowOptions();
  DUBSAR_ASSIGN(view.stage.catalog, user_catalog({}));
  DUBSAR_ASSIGN(LensTuner tuner, LensTuner::create(view.stage.catalog, folder, options.adjust[0], options.calibration));
  view.stage.display = tuner.display();
  view.stage.subject = Subject::kPattern;
  DUBSAR_ASSIGN(view.mapping, default_mapping());
  view.inputs = {"keyboard"};
  view.window->title = "dubsar: " + options.adjust[0];
  view.window->monitor = options.monitor;
  view.commands = tuner.commands();
  log_info(
      "one number should fill the panel: left and right move the views, up and down change the pitch, page up and page "
      "down the slope; "
      "s saves, 0 goes back, Escape ends");
  DUBSAR_ASSIGN(const ViewResult done, run_view(TriMesh(), view, progress));
  VerbResult result;
  result.json = {
      {"panel", options.adjust[0]}, {"figures", tuner.text()}, {"saved", tuner.saved()}, {"frames", done.frames}};
  result.text = fmt::format("panel {}: {}{}\n", options.adjust[0], tuner.text(),
                            tuner.saved() ? "; saved in " + tuner.file().string() : "; not saved");
  return result;
}

Result<VerbResult> adjust(const std::vector<std::string>& words) {
  if (words.size() != 2)
    return fail(ErrorKind::kUsage,
                "--adjust: no figures found, expected PANEL pitch=..,slope=..,center=.., PANEL reset, or --window");
  const fs::path folder = panel_folder();
  if (folder.empty())
    return fail(ErrorKind::kCannotCreate, "cannot save the adjustment: neither XDG_CONFIG_HOME nor HOME is set");
  VerbResult result;
  result.json["panel"] = words[0];
  if (words[1] == "reset") {
    DUBSAR_ASSIGN(const bool removed, remove_adjustment(folder, words[0]));
    result.json["removed"] = removed;
    result.text =
        fmt::format("panel {}: {}\n", words[0], removed ? "the adjustment was removed" : "there was no adjustment");
    return result;
  }
  DUBSAR_ASSIGN(const PanelAdjustment adjustment, parse_adjustment(words[1]));
  DUBSAR_ASSIGN(const fs::path file, save_adjustment(folder, words[0], adjustment));
  result.json["file"] = file.string();
  result.text = fmt::format("panel {}: saved in {}\n", words[0], file.string());
  return result;
}

Result<VerbResult> run(const DisplaysRequest& options, Progress& progress) {
  if (options.window && options.adjust.empty())
    return fail(ErrorKind::kUsage, "--window found, expected --adjust PANEL too");
  if (options.window) return adjust_in_window(options, progress);
  if (!options.adjust.empty()) return adjust(options.adjust);
  if (!options.crosstalk.empty()) return crosstalk(options.crosstalk);
  if (!options.check_eyes.empty()) return check_tracker(options, progress);
  if (options.of_check)
    return fail(ErrorKind::kUsage,
                "--input, --seconds and --delay-ms are of --check-eyes, expected --check-eyes PANEL too");
  DUBSAR_ASSIGN(const auto catalog, user_catalog(options.plugins));
  const PanelSet& panels = catalog->panels();
  VerbResult result;
  result.json["panel_folder"] = panel_folder().string();
  add_sinks(*catalog, options, result);
  add_panels(panels, result);
  result.text += fmt::format("  your own profiles and adjustments: {}\n",
                             panel_folder().empty() ? "HOME is not set" : panel_folder().string());
  DUBSAR_TRY(add_calibrations(options, panels, result));
  add_monitors(options, panels, result);
  return result;
}

}  // namespace

Verb add_displays_verb(Arguments program) {
  auto options = std::make_shared<DisplaysRequest>();
  Arguments command =
      program.command("displays", "what pictures can be shown on: displays, panels, calibrations, monitors");
  command
      .value("--adjust", options->adjust,
             "save lens figures found by eye: PANEL pitch=..,slope=..,center=.. (or PANEL reset)")
      .words(1, 2)
      .called("PANEL FIGURES");
  command.flag("--window", options->window, "with --adjust PANEL: find the figures by eye, on the panel, with keys");
  command.value("--monitor", options->monitor, "with --window: part of the panel's monitor name");
  command
      .value("--crosstalk", options->crosstalk,
             "how much light of the wrong eye a tracked panel lets through, against head speed and latency")
      .called("PANEL");
  command
      .value("--check-eyes", options->check_eyes,
             "what a head tracker is worth before a tracked panel: light of the wrong eye, live, while somebody moves")
      .called("PANEL");
  command.value("--input", options->input, "with --check-eyes: the tracker (head:opentrack)").called("SOURCE");
  command.value("--seconds", options->seconds, "with --check-eyes: how long (10)").range(0.5, 3600.0);
  command.value("--delay-ms", options->delay_ms, "with --check-eyes: from a head's move to the light for it (40)")
      .range(0.0, 500.0);
  command.reads("--calibration", options->calibration, "also look at this calibration file").called("FILE");
  command
      .value("--bridge-port", options->bridge_port,
             "port of Looking Glass Bridge on this machine (33334); 0: leave it alone")
      .range(0, 65535);
  command.value("--edids", options->edids, "folder with the kernel's connectors").called("FOLDER");
  command.value("--plugin", options->plugins, "a display from a shared library; loading it runs its code")
      .called("FILE.so");
  command.footer(
      "Examples:\n"
      "  dubsar displays\n"
      "  dubsar displays --json -\n"
      "  dubsar displays --crosstalk spatiallabs-15.6\n"
      "  dubsar displays --check-eyes spatiallabs-15.6 --input head:opentrack\n"
      "  dubsar render --pattern -o pattern.png --display lenticular:looking-glass-go\n"
      "  dubsar displays --adjust looking-glass-go pitch=80.74,center=0.31\n"
      "  dubsar displays --adjust spatiallabs-15.6 --window");
  return {command, [options, command](const CommonOptions&, Progress& progress) {
            options->of_check = command.given("--input") || command.given("--seconds") || command.given("--delay-ms");
            return run(*options, progress);
          }};
}

}  // namespace dubsar::app
