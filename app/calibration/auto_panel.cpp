#include "app/calibration/auto_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "app/cli/config_folder.h"
#include "core/base/atomic_file.h"
#include "display/sinks/output_sink.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

bool is_auto(const std::pair<std::string, std::string>& option) {
  return (option.first == "auto" && option.second.empty()) || (option.first == "panel" && option.second == "auto");
}

std::string file_name_of(const FoundCalibration& found) {
  std::string name;
  for (const char c : found.serial.empty() ? found.panel->name : found.serial)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  return name + ".visual.json";
}

/// The file with the calibration, made where there is none that options can name.
Result<fs::path> file_of(const FoundCalibration& found, const fs::path& cache_folder) {
  const bool is_file = found.route == "file" || found.route == "usb_storage";
  if (is_file && found.place.find(',') == std::string::npos) return fs::path(found.place);
  if (cache_folder.empty())
    return fail(ErrorKind::kCannotCreate,
                "panel {}: its calibration cannot be kept, neither XDG_CACHE_HOME nor HOME is set", found.panel->name);
  std::error_code error;
  fs::create_directories(cache_folder, error);
  const fs::path file = cache_folder / file_name_of(found);
  DUBSAR_TRY(write_file_atomically(file, found.text));
  return file;
}

/// Readable calibrations, one a unit: the first route that has it.
std::vector<const FoundCalibration*> units_of(const CalibrationReport& report) {
  std::vector<const FoundCalibration*> units;
  for (const FoundCalibration& found : report.found) {
    const bool known = std::any_of(units.begin(), units.end(), [&](const FoundCalibration* other) {
      return !found.serial.empty() && other->serial == found.serial;
    });
    if (found.panel && !known) units.push_back(&found);
  }
  return units;
}

std::string reasons_of(const CalibrationReport& report) {
  std::string out;
  for (const FoundCalibration& found : report.found)
    if (!found.panel) out += fmt::format("{}{}: {}", out.empty() ? "" : "; ", found.route, found.problem);
  for (const auto& [route, why] : report.missing) out += fmt::format("{}{}: {}", out.empty() ? "" : "; ", route, why);
  return out;
}

}  // namespace

Result<std::string> choose_panel_options(const PanelFacts& facts, std::span<const PanelProfile> profiles,
                                         const fs::path& cache_folder) {
  std::vector<const FoundCalibration*> units = units_of(facts.calibrations);
  std::vector<const PanelProfile*> tracked;
  std::string looking_glass;  // connected, by its EDID
  for (const ConnectedEdid& each : facts.edids) {
    if (!each.edid) continue;
    const auto panels = panels_of_edid(profiles, *each.edid);
    if (panels.empty()) continue;
    if (panels[0]->kind == PanelKind::kTracked) {
      tracked.insert(tracked.end(), panels.begin(), panels.end());
      continue;
    }
    looking_glass = fmt::format("{} at {}", each.edid->name, each.connector);
    const auto same_unit = [&](const FoundCalibration* unit) {
      return !unit->serial.empty() && (unit->serial == each.edid->name || unit->serial == each.edid->serial);
    };
    if (const auto own = std::find_if(units.begin(), units.end(), same_unit); own != units.end() && units.size() > 1)
      units = {*own};
  }
  if (units.size() + tracked.size() > 1) {
    std::string names;
    for (const FoundCalibration* unit : units)
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", unit->panel->name, unit->place);
    for (const PanelProfile* panel : tracked) names += fmt::format("{}{}", names.empty() ? "" : ", ", panel->name);
    return fail(ErrorKind::kUsage,
                "several panels are here: {}; expected panel=NAME or calibration=FILE instead of auto", names);
  }
  if (!tracked.empty()) return "panel=" + tracked[0]->name;
  if (units.empty() && !looking_glass.empty())
    return fail(ErrorKind::kUnavailable, "a Looking Glass is connected ({}), but its calibration was not found: {}",
                looking_glass, reasons_of(facts.calibrations));
  if (units.empty()) return fail(ErrorKind::kUnavailable, "no panel was found: {}", reasons_of(facts.calibrations));
  DUBSAR_ASSIGN(const fs::path file, file_of(*units[0], cache_folder));
  return fmt::format("panel={},calibration={}", units[0]->panel->name, file.string());
}

Result<std::string> resolve_display(std::string_view display, int bridge_port) {
  const std::size_t colon = display.find(':');
  if (colon == std::string_view::npos) return std::string(display);
  const auto options = parse_sink_options(display.substr(colon + 1));
  if (std::none_of(options.begin(), options.end(), is_auto)) return std::string(display);
  DUBSAR_ASSIGN(const auto profiles, load_profiles(panel_folder()));
  const SteadyClock clock;
  const PanelFacts facts{find_calibrations(search_this_machine(bridge_port, clock), profiles, clock),
                         read_connected_edids()};
  DUBSAR_ASSIGN(const std::string chosen, choose_panel_options(facts, profiles, calibration_cache()));
  std::string out(display.substr(0, colon + 1));
  for (const auto& option : options) {
    if (out.back() != ':') out += ',';
    if (is_auto(option))
      out += chosen;
    else
      out += option.first + (option.second.empty() ? "" : "=" + option.second);
  }
  return out;
}

}  // namespace dubsar::app
