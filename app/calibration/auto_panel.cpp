#include "app/calibration/auto_panel.h"

#include <fmt/format.h>

#include <algorithm>

namespace dubsar::app {

namespace {

bool is_auto(const SinkOption& option) {
  return (option.key == "auto" && !option.value) || (option.key == "panel" && option.value == "auto");
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

Result<PanelProfile> choose_auto_panel(const PanelFacts& facts, const PanelSet& known) {
  std::vector<const FoundCalibration*> units = units_of(facts.calibrations);
  std::vector<const PanelProfile*> tracked;
  std::string looking_glass;  // connected, by its EDID
  for (const ConnectedEdid& each : facts.edids) {
    if (!each.edid) continue;
    const auto panels = panels_of_edid(known, *each.edid);
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
  if (!tracked.empty()) return *tracked[0];
  if (units.empty() && !looking_glass.empty())
    return fail(ErrorKind::kUnavailable, "a Looking Glass is connected ({}), but its calibration was not found: {}",
                looking_glass, reasons_of(facts.calibrations));
  if (units.empty()) return fail(ErrorKind::kUnavailable, "no panel was found: {}", reasons_of(facts.calibrations));
  return *units[0]->panel;
}

bool names_auto_panel(const SinkSpec& display) {
  return std::any_of(display.options.begin(), display.options.end(), is_auto);
}

SinkSpec with_panel(SinkSpec display, const PanelProfile& panel) {
  for (SinkOption& option : display.options)
    if (is_auto(option)) option = {"panel", panel.name};
  return display;
}

}  // namespace dubsar::app
