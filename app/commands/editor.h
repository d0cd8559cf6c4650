#pragma once
// What commands act on: the document with its history, what is open in the window, and the place they are given in.

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/history.h"
#include "app/document/other_work.h"
#include "app/document/ui_state.h"
#include "core/base/result.h"

namespace dubsar::app {

/// What a session can do besides changing its document. A window has one, tests have another.
class Workplace {
 public:
  virtual ~Workplace() = default;
  virtual Result<void> switch_display(int step) = 0;  ///< 1: the next one, -1: the one before, 0: this one, made again
  virtual Result<void> toggle_fullscreen() = 0;
  virtual Result<void> swap_eyes() = 0;  ///< kUnavailable where the display has not two views
  virtual void retry_sources() = 0;
  virtual void recentre_heads() = 0;  ///< trackers whose heading drifts: the present one is straight ahead
  virtual bool toggle_source(std::size_t index) = 0;  ///< false: there is no such source
  /// Begins to read a surface, which takes the place of the present one when it is there. kUsage: not here, or no
  /// surface by its name; kNoInput.
  virtual Result<void> open_file(const std::string& path) = 0;
  virtual Result<void> open_recent(std::size_t number) = 0;  ///< counted from 1
  virtual Result<void> switch_file(int step) = 0;            ///< of those that are open; kUsage: there is no other
  virtual std::string next_file() const = 0;                 ///< of those that are open; empty: there is no other
  virtual bool stop_opening() = 0;                           ///< false: none is being read
  virtual std::string present_folder() const = 0;            ///< where the open dialogue begins
  virtual std::string today() const = 0;                     ///< as 2026-11-27, UTC
  virtual void say(std::string words) = 0;                   ///< one line over the picture, for some seconds
  virtual void end() = 0;

  /// The place of the surface that is nearest to a point.
  virtual Result<SurfacePin> pin(const glm::dvec3& at_mm) = 0;
  /// What comes of a measure's points.
  virtual Result<MeasureFigures> figures(const Measure& measure) = 0;
  /// How far the surface reaches along a direction of the home view (right, up, to the viewer), and which direction of
  /// the scan that is.
  struct Reach {
    glm::dvec3 direction{0.0, 0.0, 1.0};
    double from_mm = 0.0, to_mm = 0.0;
  };
  virtual Reach reach(const glm::dvec3& home_direction) = 0;
  /// The direction of the scan towards the viewer, as things stand.
  virtual Reach reach_to_viewer() = 0;
  /// The place of the surface under the pointer, in the middle of the window where there is none. kUsage: no surface.
  virtual Result<SurfacePin> pin_seen() = 0;
  /// Directions of the scan, as things stand: to the right of the window, upwards, to the viewer.
  virtual glm::dmat3 seen_axes() = 0;
  /// Slice `which` (0 x, 1 y, 2 z, 3 free) of the scan as a picture, a pixel for each voxel, with the outline of the
  /// surface.
  virtual Result<void> write_slice(const std::string& path, std::size_t which) = 0;
  /// What is seen as a picture, `factor` times as large as in the window. Says where it is.
  virtual Result<void> picture(const std::string& path, int factor) = 0;
  /// Begins to look for the wedges of a part (empty: of the tablet); the document has them as one step once they are
  /// there. kUsage: there is no such part.
  virtual Result<void> find_wedges(const std::string& part) = 0;
  virtual bool stop_wedges() = 0;  ///< false: none are being looked for
  /// Begins to write what is published of the surface (kExportKinds) as the window's choice says; an empty path: beside
  /// the surface. kUsage: there is no file of it.
  virtual Result<void> publish(const std::string& kind, const std::string& path) = 0;
  virtual bool stop_publishing() = 0;  ///< false: nothing is being written
  /// Shows the document's film from its beginning, or stops it; `from_s`: from then on, whether or not it is shown now.
  virtual Result<void> play_film(std::optional<double> from_s) = 0;
};

/// How a view that a command changed is gone to.
enum class Transition {
  kJump,   ///< at once: steps of keys
  kGlide,  ///< as a hand would turn the object
};

/// How large steps are, and how far one may go.
struct StepFigures {
  double turn_deg = 5.0, zoom = 1.1;
  double zoom_min = 0.2, zoom_max = 20.0;
};

/// One thread.
class Editor {
 public:
  Editor(Document first, Workplace& place, const StepFigures& steps = {})
      : opened_(first), history_(std::move(first)), place_(&place), steps_(steps) {}
  /// Goes on with what was done before. `opened`: as it was when the session began.
  Editor(History history, Document opened, Workplace& place, const StepFigures& steps)
      : opened_(std::move(opened)), history_(std::move(history)), place_(&place), steps_(steps) {}

  const Document& document() const noexcept { return history_.now(); }
  const History& history() const noexcept { return history_; }
  const StepFigures& steps() const noexcept { return steps_; }
  UiState& ui() noexcept { return ui_; }
  const UiState& ui() const noexcept { return ui_; }
  Workplace& place() noexcept { return *place_; }

  /// A step of the document.
  void change(Document next, std::string_view words, Transition transition = Transition::kJump);
  /// What another window made of the same surface is here, too; undo leaves it alone. `next`: the document with it.
  void join(Document next);
  /// Changes in a row under the same number other than 0 are one step: those of a drag, or of a key that is held.
  void merge_with(std::uint64_t merge) noexcept { merge_ = merge; }
  bool undo();
  bool redo();
  /// As it was when the session began.
  const Document& opened() const noexcept { return opened_; }
  /// The document differs from how it was opened, in anything but where it is looked at from.
  bool has_work() const;
  /// Work that was found beside that of the surface, whose notes can be taken over.
  void set_others(std::vector<OtherWork> others) { others_ = std::move(others); }
  const std::vector<OtherWork>& others() const noexcept { return others_; }
  /// How the view of the last change is gone to.
  Transition transition() const noexcept { return transition_; }

 private:
  Document opened_;
  History history_;
  Workplace* place_;
  StepFigures steps_;
  UiState ui_;
  std::vector<OtherWork> others_;
  Transition transition_ = Transition::kJump;
  std::uint64_t merge_ = 0;
};

}  // namespace dubsar::app
