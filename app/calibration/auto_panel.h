#pragma once
// "auto" for a panel's name: the one that is here, by its calibration or by its EDID.

#include <filesystem>
#include <string>
#include <string_view>

#include "app/calibration/calibration_search.h"
#include "display/panels/edid.h"

namespace dubsar::app {

/// What is known about this machine's panels.
struct PanelFacts {
  CalibrationReport calibrations;
  std::vector<ConnectedEdid> edids;
};

/// Options for a sink in place of "auto": "panel=NAME,calibration=FILE" or "panel=NAME". A calibration that
/// came by another way than a file is kept in `cache_folder` (SERIAL.visual.json), so that it can be named
/// later. kUnavailable, with the reasons, when no panel is found; kUsage, with their names, when several are.
Result<std::string> choose_panel_options(const PanelFacts& facts, std::span<const PanelProfile> profiles,
                                         const std::filesystem::path& cache_folder);

/// "lenticular:auto,nearest" with `auto` (or panel=auto) replaced by what this machine has; other displays
/// come back as they are, and nothing is looked for. `bridge_port` as search_this_machine().
Result<std::string> resolve_display(std::string_view display, int bridge_port);

}  // namespace dubsar::app
