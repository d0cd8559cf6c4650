#pragma once
// What a session is asked for, what it tells while it runs, and what comes of it.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/command_table.h"
#include "app/commands/step_script.h"
#include "app/document/document.h"
#include "app/session/file_loader.h"
#include "app/session/session_work.h"
#include "app/stage/stage.h"
#include "app/steering/source_set.h"
#include "core/base/numbers/measurements.h"
#include "display/render/context/context_glfw.h"
#include "input/navigation/mapping.h"

namespace dubsar::app {

class SessionController;  // app/tools/session_controller.h

struct SessionTime {
  /// Simulated time: this many steps a second, however long they take; the same script gives the same pictures on every
  /// machine. 0: real time, in a window only.
  double fps = 0.0;
  double longest_s = 0.0;        ///< 0: until somebody ends it, or its scripts and recordings are over (plus 1 s)
  double display_delay_s = 0.0;  ///< from the presentation of a picture to its light, beyond the monitor's scan
  /// Asked at each turn in real time: what the session was begun with is so no longer, such as its monitor; it ends.
  std::function<bool()> outdated{};
};

/// What a session writes; none where it is empty.
struct SessionFiles {
  std::filesystem::path frames{};  ///< folder for frame-00000.png ..., what is presented
  /// Only each n-th picture becomes a file; in simulated time nothing else is drawn, and pictures count steps.
  int every = 1;
  std::filesystem::path record{};  ///< recording of the input
};

/// Another panel of the same session (side_panels.h).
struct SidePanelOptions {
  std::string name{};  ///< what messages call its display
  SinkSpec display{"mono"};
  std::shared_ptr<SinkCatalog> catalog = std::make_shared<SinkCatalog>();
  WindowOptions window{};            ///< where the session has windows
  std::optional<bool> fullscreen{};  ///< as ViewOptions::fullscreen
  Screen screen{};                   ///< where it has none, what the display does not know better
  std::string problem{};             ///< not empty: why it cannot be shown, now or ever
};

/// How one stands when the session is over.
struct PanelOutcome {
  std::string display{}, trouble{};  ///< trouble: why it could not be shown at last; empty: it could
  int frames = 0;
};

/// What stands around the surface.
struct SessionWords {
  bool panels = false;  ///< on displays of one view; a key shows them on all
  double scale = 0.0;   ///< of letters and panels; 0: as the monitor wants it
  std::string title{};  ///< what the panels call it
  bool notices = true;  ///< a line for some seconds: how to get help and leave, which display this is now
};

/// Where a session gets inputs and other surfaces from.
struct SessionSources {
  std::filesystem::path model_folder{};  ///< networks of the webcam source; empty: none
  MakeInput make = make_input;
  ReadSurface beside{};  ///< reads what documents set beside their surface; none: nothing
};

struct ViewOptions {
  StageOptions stage{};
  SessionWork work{};
  Mapping mapping{};
  std::vector<std::string> inputs;  ///< none in a window: mouse, keyboard, and the devices that are plugged in
  SessionSources sources{};
  std::optional<WindowOptions> window;  ///< none: offscreen, pictures in memory and files
  /// Whether the window covers a monitor. None: displays that need exact pixels do, on the monitor of
  /// `window.monitor`, else the one that has the panel's pixels; others do not.
  std::optional<bool> fullscreen;
  std::vector<SinkSpec> displays;  ///< what the keys go through besides stage.display; none: what fits the window
  SessionTime time{};
  SessionFiles files{};
  std::vector<TimedCommand>
      steps{};                      ///< said at their times, from the first picture on; one that fails ends the session
  std::vector<Command> commands{};  ///< in place of those that change what is looked at
  SessionWords around{};
  std::vector<SidePanelOptions> also{};  ///< further panels, which show the same
  SessionController* guide = nullptr;    ///< leads the session and says when it ends; null: nobody does. Outlives it
};

/// What went into one picture. Times are those of the session's clock.
struct PictureReport {
  ViewState view{};
  Observer viewer{};  ///< the eyes that cameras were made for
  Presence head = Presence::kOff;
  Control control = Control::kNone;
  bool moving = false;                     ///< it differs from the last one
  std::optional<TimestampNs> input_age{};  ///< device time of the newest measurement to the cameras; none: nothing new
  std::optional<PanelLight> light{};       ///< where the panel's lenses send it, for displays with lenses
};

/// In real time, from the beginning of the session: to the first picture in the window, and to the first one that shows
/// something of a surface; none: there was none.
struct FirstPictures {
  std::optional<double> window_s{}, surface_s{};
};

/// Of the further panels.
struct SidePanelResults {
  std::vector<PanelOutcome> also{};
};

struct ViewResult : SidePanelResults {
  int frames = 0, written = 0;
  FirstPictures first{};
  std::size_t triangles = 0;  ///< of the surface that was shown last
  double seconds = 0.0;       ///< of the session's clock
  double fps = 0.0;           ///< in real time, while things moved: from one presented picture to the next
  ViewState view{};
  /// In real time: from one presented picture to the next, of all that were presented while things moved, however
  /// long it took. A rest in between is no interval.
  Measurements interval_ms{};
  Measurements input_age_ms{};    ///< one for every turn that had new input
  Measurements frame_cpu_ms{};    ///< CPU time of each picture, all threads
  double largest_turn_deg = 0.0;  ///< between two turns
  std::string display{};          ///< shown at the end
  std::vector<SourceRow> rows{};
  std::vector<SourceState> sources{};
  Document document{};
};

}  // namespace dubsar::app
