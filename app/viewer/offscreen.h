#pragma once
// A session without a window: simulated time, pictures in files, figures about latency.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/viewer/session.h"
#include "core/base/progress.h"

namespace dubsar::app {

struct OffscreenOptions {
  SessionOptions session{};
  std::vector<std::string> inputs;  ///< as make_input() reads them; mouse and keyboard need a window
  double fps = 30.0;
  double longest_s = 60.0;         ///< ends here, or 1 s after the last script or recording is over
  double display_delay_s = 0.0;    ///< from the cameras to the eye, for the prediction of heads
  std::filesystem::path frames{};  ///< folder for frame-00000.png ...; empty: none
  int every = 1;                   ///< only each n-th frame becomes a file
  std::filesystem::path record{};  ///< recording of the input; empty: none
};

struct OffscreenResult {
  int frames = 0, written = 0;
  double seconds = 0.0;  ///< of simulated time
  ViewState view{};
  std::vector<double> input_age_ms;  ///< one for every frame that had new input, simulated time
  std::vector<double> frame_cpu_ms;  ///< CPU time of draw(), all threads
  double largest_turn_deg = 0.0;     ///< between two frames
  std::vector<SourceState> sources;
};

/// p-quantile, p 0..1, of values (by rank); 0 of none.
double quantile(std::vector<double> values, double p);

/// Runs to its end. `look` sees every picture (RGB) with its report. Errors as Session::create, make_input and file
/// writing; kCancelled.
Result<OffscreenResult> run_offscreen(const TriMesh& mesh, const OffscreenOptions& options, Progress& progress,
                                      const std::function<void(const Image&, const FrameReport&)>& look = {});

}  // namespace dubsar::app
