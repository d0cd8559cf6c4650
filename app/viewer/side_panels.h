#pragma once
// Further panels of a session: the same document and the same moment, each with its own display, window, place and
// cameras. Nobody steers from them.

#include <memory>
#include <string>
#include <vector>

#include "app/panels/gallery_page.h"
#include "app/viewer/view_options.h"

namespace dubsar::app {

class Presenter;  // app/viewer/presenter/presenter.h
class Viewer;     // app/viewer/viewer.h

/// What a main panel shows, for one whose plane is another: lines, letters and glow keep their relation to the object.
struct PanelPlane {
  glm::dvec2 window_mm{1.0}, middle_mm{0.0};
  int view_height_px = 1;
  LabelFont* font = nullptr;  ///< of its context
};
Shown shown_on(const Shown& main, const PanelPlane& of_main, const PanelPlane& here);
/// What a gallery says on a panel that is `aspect` times as wide as high: the same sentences, tutorial, light and
/// buttons; the operator's menu is the main panel's.
GalleryPicture gallery_on(const GalleryPicture& main, double aspect);

/// One that cannot be had is tried again every 2 s where time is real, and one whose monitor is gone is taken down
/// until that is back; meanwhile the session goes on. One thread: that of the session. Each has a GL context of its
/// own; the main one is current again when a call returns.
class SidePanels {
 public:
  /// `main` outlives it.
  SidePanels(const ViewOptions& session, Presenter& main);
  ~SidePanels();
  SidePanels(const SidePanels&) = delete;
  SidePanels& operator=(const SidePanels&) = delete;

  /// What `viewer` shows now goes to all, and is painted and presented where it changed: in simulated time on all, else
  /// on the one that waits longest, so that the main panel does not wait for all. `frame` not empty: on all, and each
  /// picture is a file beside that of the main panel, "`frame`-2", -3 and so on. Errors of the files, and of the main
  /// panel's context.
  Result<void> follow(Viewer& viewer, TimestampNs now, const std::string& frame = {});
  /// Another session with the same panels begins: windows stay, what they show is the new one's.
  void begin(const ViewOptions& session);
  /// The surface of the session, or the session, is about to go: what was made of it goes first.
  void drop_surface();
  /// As those of the presenter; none of them takes the keys from another window of the session.
  void look_after();
  bool focused() const;
  /// One of them has something to paint.
  bool need_paint() const;
  bool empty() const noexcept { return panels_.empty(); }

  /// How each stands, in the order of the options.
  std::vector<PanelOutcome> states() const;
  /// In words, of those that cannot be shown now; empty: all are.
  std::string trouble() const;

 private:
  struct Panel;
  Result<void> follow_all(Viewer& viewer, TimestampNs now, const std::string& frame);
  Result<bool> show(Panel& panel, const Viewer& viewer, TimestampNs now);
  static Result<void> say(Panel& panel, const Viewer& viewer);
  void open(Panel& panel);
  void look_after(Panel& panel, TimestampNs now);
  void hear(Panel& panel);
  static Result<void> make_stage(Panel& panel, const Viewer& viewer);
  static Result<void> place(Panel& panel);
  static Result<void> paint(Panel& panel, const std::string& file);
  void fails(Panel& panel, const Error& error, TimestampNs now);

  struct Session {
    bool windows = false, simulated = false, led = false;
  };
  Session session_;
  Presenter& main_;
  Viewer* viewer_ = nullptr;  // who hears keys
  std::vector<std::unique_ptr<Panel>> panels_;
  TimestampNs looked_ = -1;  // for monitors
};

}  // namespace dubsar::app
