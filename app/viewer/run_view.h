#pragma once
// The loop of a session, for windows and for pictures in memory, in real and in simulated time.

#include "app/viewer/viewer.h"
#include "core/base/progress.h"

namespace dubsar::app {

/// What a test or a recorder sees after each turn of the loop.
struct ViewMoment {
  const PictureReport& report;
  bool drawn = false;  ///< a picture was presented in this turn
  int frames = 0;
  const Viewer& viewer;
  Presenter& presenter;
};

class SidePanels;  // app/viewer/side_panels.h

/// Windows that go on from one session to the next, with the last picture on them until there is another one.
struct KeptPanels {
  KeptPanels();
  ~KeptPanels();
  SinkSpec display{};
  std::unique_ptr<Presenter> main;
  std::unique_ptr<SidePanels> also;  // goes first
};

/// Runs until the window is closed, a script or recording was the only input and is over (plus 1 s), or longest_s.
/// In real time the newest input is read when a picture is begun, cameras are made for the moment its light reaches the
/// eye, and nothing is drawn while nothing changes. A recording is complete whatever ends the session. Errors: those of
/// the presenter, the stage and the sources; kCancelled; a picture that cannot be drawn three times in a row. Main
/// thread.
/// With a loader `mesh` may be without triangles: the loader's files are shown, the first of `files` first, once they
/// are read; without files the open dialogue is. `kept` has the windows of a session before with the same display and
/// panels, or nothing, and gets those of this one.
Result<ViewResult> run_view(const TriMesh& mesh, const ViewOptions& options, Progress& progress,
                            const std::function<void(const ViewMoment&)>& look = {}, FileLoader* loader = nullptr,
                            KeptPanels* kept = nullptr);

}  // namespace dubsar::app
