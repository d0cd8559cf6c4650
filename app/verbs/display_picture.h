#pragma once
// `dubsar render --display`: the panel's picture of a mesh or of the test pattern, and what an eye sees of it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/verb.h"
#include "core/mesh/tri_mesh.h"
#include "devices/looking_glass/bridge_client.h"
#include "display/sinks/render_display.h"

namespace dubsar::app {

struct DisplayRequest {
  std::string display;                    ///< NAME[:options]; empty: no display
  std::string see_from;                   ///< X,Y,Z in mm, or empty
  std::string viewer;                     ///< X,Y,Z in mm of the point between the eyes, or empty
  std::string screen_mm;                  ///< WIDTHxHEIGHT, or empty
  std::optional<double> eye_distance_mm;  ///< 63
  double magnification = 0.0;
  bool sized = false;                ///< somebody gave the screen's pixels
  std::string of_surfaces{};         ///< an option that was given and is about surfaces; empty: none
  std::vector<std::string> plugins;  ///< files
  int bridge_port = kBridgePort;     ///< for panel "auto"
  bool pattern = false;
};

/// `surfaces`: also the options that are about them.
void add_display_options(Arguments command, DisplayRequest& request, bool surfaces = true);

/// Fills screen, viewer and catalog of `options`; its screen has the pixels already. Returns the display. kUsage for
/// texts that cannot be read, and for options that the display does not look at; errors of choose_display.
Result<SinkSpec> read_display_options(const DisplayRequest& request, DisplayOptions& options);

/// Renders (`mesh` is not looked at for the pattern) and writes `out`, whose name gets the display's suffix when it
/// lacks it.
Result<VerbResult> render_to_display(const DisplayRequest& request, const SinkSpec& display,
                                     const DisplayOptions& options, const TriMesh& mesh,
                                     const std::filesystem::path& out, Progress& progress);

/// The picture, or with --see-from what that eye sees of it.
Result<Image> seen_picture(const DisplayRequest& request, const DisplayPicture& picture);

/// Writes `picture`, or with --see-from what that eye sees of it, to `out`, whose name gets the display's suffix; the
/// JSON says which file, the text begins with it.
Result<VerbResult> write_display_picture(const DisplayRequest& request, const SinkSpec& display,
                                         const DisplayOptions& options, const DisplayPicture& picture,
                                         const std::filesystem::path& out);

}  // namespace dubsar::app
