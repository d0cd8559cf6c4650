#pragma once
// The three people of the documentation's strips, as sessions in a window in simulated time: a visitor before
// a Looking Glass, a scholar before a weaved panel, a developer with simulated devices and a recording.

#include <filesystem>
#include <string>
#include <vector>

#include "app/viewer/run_view.h"
#include "display/sinks/render_display.h"
#include "tests/display/xvfb_server.h"

namespace dubsar::testing {

struct SessionMoment {
  double time_s = 0.0;
  Image window;  ///< what the X server has on its screen there
  app::PictureReport report;
};

struct StagedSession {
  app::ViewResult result;
  std::vector<SessionMoment> moments;
};

struct Stage {
  std::string display;
  int width = 0, height = 0;   ///< of the window, at the screen's corner
  std::string view = "front";  ///< the home view
  double fps = 60.0;
  int every = 1;  ///< a picture at each n-th step
  double longest_s = 60.0;
  std::filesystem::path panel_folder{};
};

/// Runs a session to its end in a window of the server. `inputs` as of `dubsar view --input`.
Result<StagedSession> play(const XvfbServer& server, const TriMesh& mesh, const Stage& stage,
                           const std::vector<std::string>& inputs, const std::filesystem::path& record = {});

/// Tile `index` of a quilt, 0 at the lower left.
Image quilt_tile(const Image& quilt, int columns, int rows, int index);

/// What the two eyes of a head (63 mm apart) see of a panel of lenses at that moment, and how much of it was
/// meant for them.
struct SeenPair {
  Image left, right;
  EyeLight left_light, right_light;
};
Result<SeenPair> seen_from(const SessionMoment& moment, const glm::dvec3& head_mm);

}  // namespace dubsar::testing
