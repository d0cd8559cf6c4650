#pragma once
// What commands act on: the document with its history, what is open on the desk, and the place they are given in.

#include <cstdint>
#include <string>
#include <string_view>

#include "app/document/history.h"
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
  virtual void say(std::string words) = 0;            ///< one line over the picture, for some seconds
  virtual void end() = 0;
};

/// How a view that a command changed is gone to.
enum class Way {
  kJump,   ///< at once: steps of keys
  kGlide,  ///< as a hand would turn the object
};

/// What is open; not part of the document, and not undone.
struct Desk {
  bool help = false;
  bool panels = false;
  std::string drawer{};  ///< of the panels; empty: none is open
  friend bool operator==(const Desk&, const Desk&) = default;
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
      : history_(std::move(first)), place_(&place), steps_(steps) {}

  const Document& document() const noexcept { return history_.now(); }
  const History& history() const noexcept { return history_; }
  const StepFigures& steps() const noexcept { return steps_; }
  Desk& desk() noexcept { return desk_; }
  const Desk& desk() const noexcept { return desk_; }
  Workplace& place() noexcept { return *place_; }

  /// A step of the document.
  void change(Document next, std::string_view words, Way way = Way::kJump);
  /// Changes in a row under the same number other than 0 are one step: those of a drag, or of a key that is held.
  void merge_with(std::uint64_t merge) noexcept { merge_ = merge; }
  bool undo();
  bool redo();
  /// How the view of the last change is gone to.
  Way way() const noexcept { return way_; }

 private:
  History history_;
  Workplace* place_;
  StepFigures steps_;
  Desk desk_;
  Way way_ = Way::kJump;
  std::uint64_t merge_ = 0;
};

}  // namespace dubsar::app
