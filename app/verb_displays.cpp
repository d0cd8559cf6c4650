// dubsar displays: what there is to show pictures on, what belongs to what, and why something is missing.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/cli/config_folder.h"
#include "app/cli/verb.h"
#include "core/base/atomic_file.h"
#include "display/context_glfw.h"
#include "display/output_sink.h"
#include "display/panel_adjust.h"
#include "display/panel_profile.h"
#include "display/plugin_sink.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kMaxCalibrationBytes = 64 << 10;

struct Options {
  std::vector<std::string> adjust;  ///< PANEL, figures or "reset"
  std::string calibration;
  std::vector<std::string> plugins;
};

const char* kind_name(PanelKind kind) {
  return kind == PanelKind::kLookingGlass ? "looking_glass" : kind == PanelKind::kLensSheet ? "lens_sheet" : "tracked";
}

Result<void> add_sinks(const Options& options, VerbResult& result) {
  result.text += "displays (--display NAME[:options])\n";
  for (const SinkBackend& sink : output_sinks()) {
    result.json["displays"].push_back({{"name", sink.name}, {"summary", sink.summary}});
    result.text += fmt::format("  {:<14} {}\n", sink.name, sink.summary);
  }
  for (const std::string& file : options.plugins) {
    DUBSAR_ASSIGN(const auto plugin, SinkPlugin::load(file));
    result.json["displays"].push_back({{"name", plugin->name()}, {"summary", plugin->summary()}, {"plugin", file}});
    result.text += fmt::format("  {:<14} {} ({})\n", plugin->name(), plugin->summary(), file);
  }
  return {};
}

void add_panels(const std::vector<PanelProfile>& profiles, VerbResult& result) {
  result.text += "panels (--display lenticular:PANEL, quilt:PANEL)\n";
  for (const PanelProfile& p : profiles) {
    nlohmann::json entry{{"name", p.name},           {"title", p.title},         {"kind", kind_name(p.kind)},
                         {"width_px", p.width_px},   {"height_px", p.height_px}, {"views", p.views},
                         {"lens_figures", p.sheet.has_value() || p.optics.has_value()}, {"note", p.note}};
    if (p.adjustment.pitch) entry["adjusted"]["pitch"] = *p.adjustment.pitch;
    if (p.adjustment.slope) entry["adjusted"]["slope"] = *p.adjustment.slope;
    if (p.adjustment.center) entry["adjusted"]["center"] = *p.adjustment.center;
    result.json["panels"].push_back(std::move(entry));
    result.text += fmt::format("  {:<32} {}x{}, {} views{}{}\n", p.name, p.width_px, p.height_px, p.views,
                               p.sheet || p.optics ? "" : "; no lens figures, give calibration=FILE",
                               p.adjustment.empty() ? "" : "; adjusted by you");
  }
}

void add_calibration(const fs::path& file, const std::vector<PanelProfile>& profiles, VerbResult& result) {
  nlohmann::json entry{{"file", file.string()}};
  std::string words;
  const auto text = read_text_file(file, kMaxCalibrationBytes);
  const auto read = text ? parse_calibration(*text, file.string()) : Result<Calibration>(tl::unexpect, text.error());
  const auto profile = read ? calibrated_profile(profiles, *read) : Result<PanelProfile>(tl::unexpect, read.error());
  if (profile) {
    entry.update({{"serial", read->serial}, {"panel", profile->name}});
    words = fmt::format("{} (serial {})", profile->name, read->serial.empty() ? "not given" : read->serial);
  } else {
    entry["problem"] = profile.error().message;
    words = profile.error().message;
  }
  result.json["calibrations"].push_back(std::move(entry));
  result.text += fmt::format("  {}: {}\n", file.string(), words);
}

void add_calibrations(const Options& options, const std::vector<PanelProfile>& profiles, VerbResult& result) {
  result.json["calibrations"] = nlohmann::json::array();
  result.text += "calibrations\n";
  const std::vector<fs::path> roots = mount_folders();
  std::vector<fs::path> files = find_calibration_files(roots);
  if (!options.calibration.empty()) files.emplace_back(options.calibration);
  for (const fs::path& file : files) add_calibration(file, profiles, result);
  if (!files.empty()) return;
  std::string places;
  for (const fs::path& root : roots) places += (places.empty() ? "" : ", ") + (root / "*/LKG_calibration/visual.json").string();
  const std::string why = places.empty() ? "neither USER nor LOGNAME is set, so the folder of USB storage is not known" : "nothing at " + places;
  result.json["calibrations_missing"] = why;
  result.text += fmt::format("  none: {}; connect and mount the panel's USB storage, or use calibration=FILE\n", why);
}

void add_monitors(const std::vector<PanelProfile>& profiles, VerbResult& result) {
  result.json["monitors"] = nlohmann::json::array();
  result.text += "monitors\n";
  const auto monitors = list_monitors();
  if (!monitors) {
    result.json["monitors_missing"] = monitors.error().message;
    result.text += fmt::format("  none: {}\n", monitors.error().message);
    return;
  }
  for (const Monitor& m : *monitors) {
    // A monitor alone says too little to name a panel: makers' names and sizes make candidates.
    nlohmann::json candidates = nlohmann::json::array();
    std::string words;
    for (const PanelProfile& p : profiles) {
      const bool same_size = p.width_px == m.width_px && p.height_px == m.height_px;
      if (!same_size || p.kind == PanelKind::kLensSheet || (p.kind == PanelKind::kLookingGlass && !m.name.starts_with("LKG"))) continue;
      candidates.push_back(p.name);
      words += (words.empty() ? "; could be " : ", ") + p.name;
    }
    result.json["monitors"].push_back({{"name", m.name}, {"x", m.x}, {"y", m.y}, {"width_px", m.width_px}, {"height_px", m.height_px},
                                       {"width_mm", m.width_mm}, {"height_mm", m.height_mm}, {"refresh_hz", m.refresh_hz},
                                       {"primary", m.primary}, {"panels", candidates}});
    result.text += fmt::format("  {:<14} {}x{} pixels at {},{}, {:.0f}x{:.0f} mm, {:.0f} Hz{}{}\n", m.name, m.width_px, m.height_px, m.x,
                               m.y, m.width_mm, m.height_mm, m.refresh_hz, m.primary ? ", primary" : "", words);
  }
}

Result<VerbResult> adjust(const std::vector<std::string>& words) {
  const fs::path folder = panel_folder();
  if (folder.empty()) return fail(ErrorKind::kCannotCreate, "cannot save the adjustment: neither XDG_CONFIG_HOME nor HOME is set");
  VerbResult result;
  result.json["panel"] = words[0];
  if (words[1] == "reset") {
    DUBSAR_ASSIGN(const bool removed, remove_adjustment(folder, words[0]));
    result.json["removed"] = removed;
    result.text = fmt::format("panel {}: {}\n", words[0], removed ? "the adjustment was removed" : "there was no adjustment");
    return result;
  }
  DUBSAR_ASSIGN(const PanelAdjustment adjustment, parse_adjustment(words[1]));
  DUBSAR_ASSIGN(const fs::path file, save_adjustment(folder, words[0], adjustment));
  result.json["file"] = file.string();
  result.text = fmt::format("panel {}: saved in {}\n", words[0], file.string());
  return result;
}

Result<VerbResult> run(const Options& options) {
  if (!options.adjust.empty()) return adjust(options.adjust);
  DUBSAR_ASSIGN(const auto profiles, load_profiles(panel_folder()));
  VerbResult result;
  result.json["panel_folder"] = panel_folder().string();
  DUBSAR_TRY(add_sinks(options, result));
  add_panels(profiles, result);
  result.text += fmt::format("  your own profiles and adjustments: {}\n", panel_folder().empty() ? "HOME is not set" : panel_folder().string());
  add_calibrations(options, profiles, result);
  add_monitors(profiles, result);
  return result;
}

}  // namespace

Verb add_displays_verb(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand("displays", "what pictures can be shown on: displays, panels, calibrations, monitors");
  command->add_option("--adjust", options->adjust, "save lens figures found by eye: PANEL pitch=..,slope=..,center=.. (or PANEL reset)")
      ->expected(2)
      ->type_name("PANEL FIGURES");
  command->add_option("--calibration", options->calibration, "also look at this calibration file")->type_name("FILE");
  command->add_option("--plugin", options->plugins, "a display from a shared library; loading it runs its code")->type_name("FILE.so");
  command->footer(
      "Examples:\n"
      "  dubsar displays\n"
      "  dubsar displays --json -\n"
      "  dubsar render --pattern -o pattern.png --display lenticular:looking-glass-go\n"
      "  dubsar displays --adjust looking-glass-go pitch=80.74,center=0.31");
  return {command, [options](const CommonOptions&, Progress&) { return run(*options); }};
}

}  // namespace dubsar::app
