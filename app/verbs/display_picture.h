#pragma once
// `dubsar render --display`: the panel's picture of a mesh or of the test pattern, and what an eye sees of it.

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/verb.h"
#include "core/mesh/tri_mesh.h"
#include "devices/looking_glass/bridge_client.h"
#include "display/sinks/render_display.h"

namespace dubsar::app {

struct DisplayRequest {
  std::string display;    ///< NAME[:options]; empty: no display
  std::string see_from;   ///< X,Y,Z in mm, or empty
  std::string viewer;     ///< X,Y,Z in mm of the point between the eyes, or empty
  std::string screen_mm;  ///< WIDTHxHEIGHT, or empty
  double eye_distance_mm = 63.0, magnification = 0.0;
  std::vector<std::string> plugins;  ///< files
  int bridge_port = kBridgePort;     ///< for panel "auto"
  bool pattern = false;
};

void add_display_options(Arguments command, DisplayRequest& request);

/// Fills screen, viewer and catalog of `options`; its screen has the pixels already. Returns the display. kUsage for
/// texts that cannot be read; errors of choose_display.
Result<SinkSpec> read_display_options(const DisplayRequest& request, DisplayOptions& options);

/// Renders (`mesh` is not looked at for the pattern) and writes `out`, whose name gets the display's suffix when it
/// lacks it.
Result<VerbResult> render_to_display(const DisplayRequest& request, const SinkSpec& display,
                                     const DisplayOptions& options, const TriMesh& mesh,
                                     const std::filesystem::path& out, Progress& progress);

}  // namespace dubsar::app
