#pragma once
// A session: the document and who may change it. Commands, people and keys change it; the stage shows it.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/key_table.h"
#include "app/panels/overlay.h"
#include "app/session/shelf.h"
#include "app/stage/film_thumbnails.h"
#include "app/stage/picker.h"
#include "app/steering/steering.h"
#include "app/tools/cut_box.h"
#include "app/tools/session_guide.h"
#include "app/tools/slice_desk.h"
#include "app/tools/surface_tools.h"
#include "app/viewer/presenter/presenter.h"
#include "display/render/images/label_font.h"
#include "input/gestures/touch_pointer.h"
#include "input/input_recorder.h"
#include "input/window_events.h"
#include "input/worn_feed.h"

namespace dubsar::app {

/// What a click with a tool is among the keys, so that each comes in its turn.
inline constexpr std::string_view kClickKey = "click";

/// Figures for the page of help, from whoever measures them.
struct RecentFigures {
  std::vector<double> interval_ms, input_age_ms;
};

/// One thread: that of the GL context.
class Viewer final : public Workplace {
 public:
  /// Starts the sources, too. `mesh`, `presenter`, `clock` and `shelf` outlive it; events of the presenter's window
  /// come here. A mesh without triangles: the surface comes from the shelf; null: there is no other than `mesh`. Errors
  /// of Stage::create, SourceSet::start, the recording, and of the mapping's keys.
  static Result<std::unique_ptr<Viewer>> create(const TriMesh& mesh, const ViewOptions& options, Presenter& presenter,
                                                const Clock& clock, std::unique_ptr<OutputSink> sink,
                                                const std::string& note, Shelf* shelf = nullptr);
  ~Viewer() override;

  /// Everything up to `now`: sources, keys, commands; then what the next picture shows, whose light reaches the eye at
  /// `display_time`.
  void tick(TimestampNs now, TimestampNs display_time, const RecentFigures& figures);
  const PictureReport& report() const noexcept { return report_; }
  bool needs_paint() const noexcept { return stage_->needs_paint(); }
  Result<bool> work() { return stage_->work(); }  ///< as that of the stage
  Result<void> paint(const Surface& target, Field field);
  /// Two: the display shows its eyes in turn, whether or not anything changes.
  int fields() const { return stage_->traits().fields; }
  /// The window is somewhere else: the stage and the presenter follow.
  Result<void> place_changed();
  /// Whether whoever leads the session has ended it.
  bool led_to_end() const noexcept { return at_.guidance.end; }
  void presented(TimestampNs now);
  /// Another panel of the session cannot be shown, in words; empty: all can. What is new is said over the picture.
  void set_trouble(const std::string& words);
  /// Called before the present surface goes.
  void on_surface_change(std::function<void()> told) { given_.surface_goes = std::move(told); }
  /// Scripts and recordings were the only input, and are over for 1 s.
  bool over(TimestampNs now);

  /// Does what a command says. What cannot be done becomes a line over the picture.
  void run(std::string_view command, std::uint64_t merge = 0);
  /// A step of the options that could not be done, or the only file that could not be read.
  const std::optional<Error>& failed() const noexcept { return at_.failed; }
  /// An event of a window.
  void handle(InputEvent event);

  /// What simulated time waits for; the end of the recording; what an orderly end leaves behind.
  Result<void> flush() { return recorder_ ? recorder_->flush() : Result<void>(); }
  Result<void> finish();

  bool shows_surface() const noexcept { return has_surface() || files_.coarse != nullptr; }  ///< or a coarse one
  bool has_surface() const noexcept { return !given_.mesh->triangles.empty(); }
  bool opening() const noexcept { return given_.shelf != nullptr && given_.shelf->busy(); }  ///< a file is being read
  const TriMesh& mesh() const noexcept { return *given_.mesh; }
  const Stage& stage() const noexcept { return *stage_; }
  const Document& document() const noexcept { return editor_->document(); }
  const Desk& desk() const noexcept { return editor_->desk(); }
  /// What whoever leads the session has over the picture; none: nobody leads.
  const std::optional<GalleryPicture>& gallery() const noexcept { return at_.guidance.picture; }
  const KeyTable& keys() const noexcept { return *said_.keys; }
  const SlicePanelState& slices() const noexcept { return tools_.slices->state(); }
  std::string display() const { return displays_.specs[displays_.shown].text(); }
  std::vector<SourceRow> sources() const { return sources_->rows(); }
  std::vector<SourceState> source_states() const { return steering_->input().states(); }

  Result<void> switch_display(int step) override;
  Result<void> toggle_fullscreen() override { return given_.presenter.toggle_fullscreen(); }
  Result<void> swap_eyes() override;
  void retry_sources() override { sources_->retry_now(); }
  void recentre_heads() override;
  bool toggle_source(std::size_t index) override;
  Result<void> open_file(const std::string& path) override;
  Result<void> open_recent(std::size_t number) override;
  Result<void> switch_file(int step) override;
  bool stop_opening() override;
  std::string present_folder() const override;
  void say(std::string words) override;
  void end() override;
  /// False where the work cannot be kept, which is said; the second time it may all the same.
  bool may_end();
  std::string today() const override;
  Result<SurfacePin> pin(const glm::dvec3& at_mm) override;
  Result<MeasureFigures> figures(const Measure& measure) override;
  Reach reach(const glm::dvec3& home_direction) override;
  Reach reach_to_viewer() override;
  Result<SurfacePin> pin_seen() override;
  glm::dmat3 seen_axes() override;
  Result<void> write_slice(const std::string& path, std::size_t which) override;
  Result<void> picture(const std::string& path, int factor) override;
  Result<void> play_film(std::optional<double> from_s) override;

 private:
  struct Given {
    const TriMesh* mesh;
    ViewOptions options;  ///< what belongs to a file changes with it
    Presenter& presenter;
    const Clock& clock;
    Shelf* shelf;
    std::function<void()> surface_goes{};
  };
  /// A file that was left, with its undo and, where that could not be written, its work.
  struct LeftFile {
    std::unique_ptr<FileSession> session;
    Document opened;
    History history;
  };
  /// What belongs to the file that is shown, and what the dialogue lists.
  struct Files {
    std::unique_ptr<OpenedSurface> opened;
    std::unique_ptr<TriMesh> coarse;       ///< what stands for it until it is there
    std::unique_ptr<FileSession> session;  ///< keeps the work; null: nothing is kept
    std::map<std::string, LeftFile> left;  ///< those that were shown before, by their path and content
    std::string untold;                    ///< what could not be kept, as it was told last
    bool asked = false;                    ///< whether to end without having kept it
    FolderListing listing;
    std::vector<RecentFile> recent;
    TimestampNs listed = -1;
    std::string window_name;  ///< that the window was told
    bool first = false;       ///< the session was begun with a file
  };
  struct Vocabulary {
    std::unique_ptr<CommandTable> commands;
    std::unique_ptr<KeyTable> keys;
  };
  struct Displays {
    std::vector<SinkSpec> specs;
    std::size_t shown = 0;
    std::vector<ScreenRect> objects;  ///< where what is shown stands
    std::string trouble;              ///< of another panel of the session; empty: none
    std::shared_ptr<WornFeed> worn;   ///< who wears the display, for the source of their hands; null: none is worn
  };
  struct Notice {
    std::string text;
    TimestampNs since = -1;
  };
  /// What the loop and the people do, as numbers.
  struct Progression {
    TimestampNs over_since = -1, help_made = -1;
    TimestampNs film_since = -1;  ///< while a film is shown
    TimestampNs sweep_since = -1, light_moved = -1;
    bool light_known = false;
    double film_from_s = 0.0;     ///< and how far it was then
    TimestampNs began = -1;       ///< when the first step was due at 0
    TimestampNs stepped = -1;     ///< when steps were looked at last
    std::size_t steps = 0;        ///< how many were said
    std::optional<Error> failed;  ///< what became of one
    std::uint64_t presses = 0;
    Guidance guidance{};            ///< of whoever leads the session
    bool window_shown = false;      ///< a picture was presented
    bool recording_failed = false;  // and told
  };
  struct ReachedSides {
    const TriMesh* mesh = nullptr;
    glm::dquat home{1.0, 0.0, 0.0, 0.0};
    std::array<Reach, kBoxSides.size()> reach{};
  };
  /// The key of the light while it is held: a drag moves the light.
  struct HeldLight {
    InputEvent key;        ///< as it went down
    bool dragged = false;  ///< since then
  };
  /// What tools need, and what is known of the surface.
  struct Tools {
    std::unique_ptr<LabelFont> font;
    SurfaceEvidence evidence;
    std::optional<Picker> picker;
    FilmThumbnails thumbnails;
    std::optional<std::string> coming;  ///< tool of a key that is on its way
    TimestampNs field_since = -1;       ///< a key or click is on its way that opens a field of text
    std::vector<InputEvent> typed;      ///< meanwhile: it belongs into that field
    std::optional<InputEvent> press;    ///< with a tool in the hand: it becomes a click, or a drag that turns
    std::optional<HeldLight> held_light;
    std::optional<InputEvent> wheeled;  ///< the last turn of the wheel or step of fingers, with what was found there
    glm::dvec2 pointer{0.0};            ///< where it was last, as InputEvent::at
    std::unique_ptr<SliceDesk> slices;
    std::optional<ReachedSides> reached;
    std::optional<BoxDrag> held_side;  ///< of the box of cuts
    TouchPointer fingers;
  };
  Viewer(const TriMesh& mesh, const ViewOptions& options, Presenter& presenter, const Clock& clock, Shelf* shelf)
      : given_{&mesh, options, presenter, clock, shelf, {}} {}
  Result<void> open(std::unique_ptr<OutputSink> sink, const std::string& note);
  Result<void> start_sources();
  std::unique_ptr<Editor> make_editor(Document document);
  void find_tools();
  Result<void> put(OpenedSurface surface);
  void take_surface();
  void name_window();
  std::string title() const;
  void take_coarse();
  Result<void> take_if_simulated();
  std::optional<Result<void>> put_read();
  Result<void> leave_work();
  Result<void> leave_all_work();
  void leave_file();
  void keep_work(TimestampNs now);
  void take_joined(Document joined);
  void tell_of_files(std::string otherwise);
  void begin_file(Document found);
  void say_what_was_found();
  StepFigures step_figures() const;
  std::string file_key() const;
  void drop(const std::vector<std::string>& files);
  FilesState files_state(TimestampNs now);
  void use_key(const InputEvent& event);
  void expect(const InputEvent& event);
  bool use_fingers(TimestampNs now);
  void let_go_of_fingers();
  void pass_on(const InputEvent& event);
  void type_what_waited(TimestampNs now);
  void lead(TimestampNs now, const Steered& steered);
  Result<void> obey(std::string_view command, std::uint64_t merge);
  void show_document();
  void say_steps(TimestampNs now);
  PanelState panel_state(TimestampNs now);
  void add_thumbnails(PanelState& panels);
  void keep_up();
  void tell_room();
  void feed_worn();
  void follow();
  void update_overlay(TimestampNs now, const RecentFigures& figures);
  void tell_depth(InputEvent& event);
  InputEvent without_aside(InputEvent event) const;
  std::optional<Picked> picked_at(const glm::dvec2& at) const;
  bool take_click(const InputEvent& event);
  bool take_light(const InputEvent& event);
  bool take_handle(const InputEvent& event);
  CutBox cut_box();
  std::optional<BoxPicture> box_picture();
  std::optional<std::size_t> touched_handle(const BoxPicture& picture) const;
  void move_light(TimestampNs now, ViewState& view);
  void point();
  std::shared_ptr<const Shown> beside(const ViewState& view) const;
  void click(const glm::dvec2& at);
  static Result<std::filesystem::path> new_picture(const std::filesystem::path& path);
  glm::dvec3 scan_place(const Picked& picked) const;
  Document shown_document(TimestampNs now);
  Document guided_document(const GuidedScene& scene) const;
  bool shows_slices() const { return desk().panels && desk().drawer == "slices" && has_surface(); }
  double ui_scale() const;
  glm::dvec2 layout() const;
  double letters_scale() const;
  double aside() const;
  void lay_slices(Shown& shown);
  Reach reach_of(const glm::dvec3& direction, const glm::dquat& rotation) const;

  Given given_;
  Files files_;  // goes behind all that shows its surface
  Vocabulary said_;
  std::unique_ptr<Editor> editor_;
  Tools tools_;
  std::unique_ptr<Stage> stage_;
  std::unique_ptr<Overlay> overlay_;
  WindowEvents events_;
  std::unique_ptr<InputRecorder> recorder_;
  std::unique_ptr<Steering> steering_;
  std::unique_ptr<SourceSet> sources_;
  PictureReport report_;
  Displays displays_;
  Notice notice_;
  Progression at_;
};

}  // namespace dubsar::app
