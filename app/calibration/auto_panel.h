#pragma once
// "auto" for a panel's name: the one that is here, by its calibration or by its EDID.

#include <vector>

#include "app/calibration/calibration_search.h"
#include "display/panels/edid.h"
#include "display/sinks/catalog/sink_catalog.h"

namespace dubsar::app {

/// What is known about this machine's panels.
struct PanelFacts {
  CalibrationReport calibrations;
  std::vector<ConnectedEdid> edids;
};

/// The panel that is here, with the figures of its own calibration. kUnavailable, with the reasons, when none is found;
/// kUsage, with their names, when several are.
Result<PanelProfile> choose_auto_panel(const PanelFacts& facts, const PanelSet& panels);

/// True when the spec names the panel "auto" ("lenticular:auto,nearest", "quilt:panel=auto").
bool names_auto_panel(const SinkSpec& display);

/// The spec with `panel` in the place of "auto".
SinkSpec with_panel(SinkSpec display, const PanelProfile& panel);

}  // namespace dubsar::app
