#pragma once
// A session in a window, in real time: the newest input is read when a picture is begun, cameras are made for
// the moment its light reaches the eye, and nothing is drawn while nothing changes.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/offscreen.h"
#include "app/viewer/session.h"
#include "app/viewer/source_set.h"
#include "app/viewer/window_place.h"
#include "core/base/progress.h"
#include "display/render/context_glfw.h"

namespace dubsar::app {

/// What became of a key that a program of its own was asked about.
struct KeyAnswer {
  bool taken = false;            ///< it does not steer the view
  bool display_changed = false;  ///< the display's figures are others now: it is made again
  std::string notice;            ///< one line over the picture; empty: none
};

struct LiveOptions {
  SessionOptions session{};
  std::vector<std::string> inputs;  ///< none: mouse, keyboard, and the devices that are plugged in
  WindowOptions window{};
  /// Whether the window covers a monitor. None: displays that need exact pixels do, on the monitor of
  /// `window.monitor`, else the one that has the panel's pixels; others do not.
  std::optional<bool> fullscreen;
  std::vector<SinkSpec> displays;  ///< what the keys go through besides session.display; none: what fits the window
  /// 0: real time. Else simulated time: this many steps a second, however long they take, exact views, and a picture at
  /// each `every`-th step; the same script gives the same pictures on every machine.
  double simulated_fps = 0.0;
  double longest_s = 0.0;          ///< 0: until somebody ends it
  double display_delay_s = 0.0;    ///< from the presentation of a picture to its light, beyond the monitor's scan
  std::filesystem::path frames{};  ///< folder for frame-00000.png ..., what the window showed; empty: none
  int every = 1;                   ///< only each n-th frame becomes a file
  std::filesystem::path record{};  ///< recording of the input; empty: none
  bool notices = true;             ///< a line for some seconds: how to get help and leave, which display this is now
  std::function<KeyAnswer(const std::string& key)> keys;  ///< for keys that go down, but the session's own
  MakeInput make_input = dubsar::make_input;
};

struct LiveResult : OffscreenResult {  ///< times are real, or simulated
  double fps = 0.0;                    ///< of frames while things moved: from one presented picture to the next
  std::string display;                 ///< shown at the end
  std::vector<SourceRow> rows;
};

/// What a test or a recorder sees after each turn of the loop.
struct LiveMoment {
  const FrameReport& report;
  bool drawn = false;  ///< a picture was presented in this turn
  int frames = 0;
  bool help = false;
  const std::string& display;
  std::vector<SourceRow> sources;
  const Session& session;
  GlfwWindow& window;
};

/// Runs until the window is closed, a script or recording was the only input and is over (plus 1 s), or
/// longest_s. Mouse and keyboard need not be among the inputs for the session's own keys (session_keys.h).
/// Errors: those of the window, of Session::create, of SourceSet::start; kCancelled; a picture that cannot be
/// drawn three times in a row. Main thread.
Result<LiveResult> run_live(const TriMesh& mesh, const LiveOptions& options, Progress& progress,
                            const std::function<void(const LiveMoment&)>& look = {});

}  // namespace dubsar::app
