#pragma once
// A session: the document and who may change it. Commands, people and keys change it; the stage shows it.

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/key_table.h"
#include "app/panels/overlay.h"
#include "app/stage/film_thumbnails.h"
#include "app/tools/box_tool.h"
#include "app/tools/click_tool.h"
#include "app/tools/light_tool.h"
#include "app/tools/marks_tool.h"
#include "app/tools/navigate_tool.h"
#include "app/tools/session_controller.h"
#include "app/tools/touch_tool.h"
#include "app/tools/wedges_tool.h"
#include "app/viewer/companion.h"
#include "app/viewer/kept_work.h"
#include "app/viewer/step_runner.h"
#include "app/viewer/viewer_place.h"
#include "input/input_recorder.h"
#include "input/window_events.h"

namespace dubsar::app {

/// Figures for the page of help, from whoever measures them.
struct RecentFigures {
  std::vector<double> interval_ms, input_age_ms;
};

/// One thread: that of the GL context.
class Viewer final {
 public:
  /// What a session goes on with besides its options. All outlive it.
  struct Given {
    Presenter& presenter;  ///< events of its window come to the session
    const Clock& clock;
    FileLoader* loader = nullptr;          ///< surfaces that are read; null: there is no other than the first
    std::function<void()> surface_goes{};  ///< called before the present surface goes
  };
  /// Starts the sources, too. `mesh` outlives it; without triangles: the surface comes from the loader. Errors of
  /// Stage::create, SourceSet::start, the recording, and of the mapping's keys.
  static Result<std::unique_ptr<Viewer>> create(const TriMesh& mesh, const ViewOptions& options, Given given,
                                                std::unique_ptr<OutputSink> sink, const std::string& note);
  ~Viewer();

  /// Everything up to `now`: sources, events, commands; then what the next picture shows, whose light reaches the eye
  /// at `display_time`.
  void tick(TimestampNs now, TimestampNs display_time, const RecentFigures& figures);
  const PictureReport& report() const noexcept { return present_.report; }
  Result<bool> work() { return stage_->work(); }  ///< as that of the stage
  Result<void> paint(const Surface& target, Field field);
  void presented(TimestampNs now);
  /// Another panel of the session cannot be shown, in words; empty: all can. What is new is said over the picture.
  void set_trouble(const std::string& words);
  /// Scripts and recordings were the only input, and are over for 1 s.
  bool over(TimestampNs now);
  /// False where the work cannot be kept, which is said; the second time it may all the same.
  bool may_end() { return files_.kept.may_end(worked_on()); }
  /// A step of the options that could not be done, or the only file that could not be read.
  const std::optional<Error>& failed() const noexcept { return steps_.failed(); }
  /// An event of a window, which has its turn in the next tick().
  void handle(InputEvent event);

  /// What simulated time waits for; the end of the recording; what an orderly end leaves behind.
  Result<void> flush() { return input_.recorder ? input_.recorder->flush() : Result<void>(); }
  Result<void> finish();
  /// How things stood at the end.
  void tell(ViewResult& out) const;

  bool has_surface() const noexcept { return scene_.has_surface(); }
  bool shows_surface() const noexcept { return has_surface() || files_.coarse != nullptr; }       ///< or a coarse one
  bool opening() const noexcept { return files_.list.opening() || tools_->companion.opening(); }  ///< a file is read
  const TriMesh& mesh() const noexcept { return *scene_.mesh; }
  const Stage& stage() const noexcept { return *stage_; }
  const Document& document() const noexcept { return editor_->document(); }
  const UiState& ui() const noexcept { return editor_->ui(); }
  /// What whoever leads the session wants; of nobody: nothing.
  const Guidance& guidance() const noexcept { return present_.led.guidance; }
  const KeyTable& keys() const noexcept { return *said_.keys; }
  const SlicePanelState& slices() const noexcept { return tools_->slices.state(); }
  std::string display() const { return displays_->name(); }
  std::vector<SourceRow> sources() const { return input_.sources->rows(); }

 private:
  /// What belongs to the file that is shown, and to those that were.
  struct Files {
    FileList list;
    KeptWork kept;
    std::unique_ptr<OpenedSurface> opened{};
    std::unique_ptr<TriMesh> coarse{};  ///< what stands for it until it is there
    std::string window_name{};          ///< that the window was told
    bool first = false;                 ///< the session was begun with a file
    bool window_shown = false;          ///< a picture was presented: the window comes before what is read
  };
  struct Vocabulary {
    std::unique_ptr<CommandTable> commands;
    std::unique_ptr<KeyTable> keys;
  };
  /// Who takes an event first stands first.
  struct Tools {
    LightTool light;
    BoxTool box;
    ClickTool click;
    NavigateTool navigate;
    SlicesTool slices;
    MarksTool marks;
    WedgesTool wedges;
    CompanionTool companion;
    std::array<Tool*, 8> all() { return {&light, &box, &click, &navigate, &marks, &wedges, &slices, &companion}; }
  };
  /// What is known of the surface, and shown of the film.
  struct Known {
    FilmTool film;
    TouchTool touch;
    SurfaceEvidence evidence;
    FilmThumbnails thumbnails;
    WedgeFinder wedges;
    Exporter exporter;
  };
  /// An event that waits for its turn.
  struct Queued {
    InputEvent event;
    bool of_source = false;  ///< a key of a script, a recording or a SpaceMouse, which no panel or tool takes
  };
  struct Input {
    WindowEvents mouse;  ///< of the window, on its way to the source of that name
    std::unique_ptr<InputRecorder> recorder;
    std::unique_ptr<InputController> steering;
    std::unique_ptr<SourceSet> sources;
    std::deque<Queued> queue;
    TimestampNs over_since = -1;
    bool recording_failed = false;  ///< and told
  };
  struct Words {
    std::string notice;
    TimestampNs since = -1, help_made = -1;
    RecentFigures figures;
    bool behind = false;  ///< a command was done since the panels were told how things stand
  };
  struct Led {
    Guidance guidance;                ///< of whoever leads the session
    std::vector<ScreenRect> objects;  ///< where what is shown stands
    std::string trouble;              ///< of another panel of the session; empty: none
  };
  /// What the picture of this moment tells.
  struct Present {
    PictureReport report;
    Words words;
    Led led;
  };
  Viewer(const TriMesh& mesh, const ViewOptions& options, Given given);
  Result<void> open(std::unique_ptr<OutputSink> sink, const std::string& note);
  Result<void> make_vocabulary();
  void ask_the_session();
  Result<void> make_sources();
  Result<void> start_sources();
  std::unique_ptr<Editor> make_editor(History history, Document opened);
  Editor* worked_on() noexcept { return has_surface() ? editor_.get() : nullptr; }
  void begin_surface();
  Result<void> put(OpenedSurface surface);
  void take_surface();
  void take_coarse();
  std::optional<Result<void>> put_read();
  void name_window();
  std::string title() const;
  void drop(const std::vector<std::string>& files);
  void use_events(TimestampNs now);
  void use(Queued next, TimestampNs now);
  void use_key(const InputEvent& event, bool of_source);
  void run(std::string_view command, std::uint64_t merge = 0);
  Result<void> obey(std::string_view command, std::uint64_t merge);
  bool needs_surface(const Command& command) const;
  void say(std::string words);
  void keep_up();
  void follow();
  void lead(TimestampNs now, const Steered& steered);
  Document guided_document(const GuidedScene& scene) const;
  void show(TimestampNs now, const Steered& steered);
  void measure_window();
  PanelState panel_state(TimestampNs now);
  void tell_help(OverlayText& text, TimestampNs now);
  void update_overlay(TimestampNs now);

  ViewOptions options_;  ///< what belongs to a file changes with it
  Given given_;
  ToolScene scene_;
  Files files_;  // goes behind all that shows its surface
  Vocabulary said_;
  std::unique_ptr<Stage> stage_;
  std::unique_ptr<DisplaySwitch> displays_;
  Input input_;
  Known known_;
  std::unique_ptr<Tools> tools_;
  std::unique_ptr<ViewerPlace> place_;
  std::unique_ptr<Editor> editor_;
  std::unique_ptr<Overlay> overlay_;
  StepRunner steps_;
  Present present_;
};

}  // namespace dubsar::app
