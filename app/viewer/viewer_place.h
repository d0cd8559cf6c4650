#pragma once
// What commands of a session can do besides changing its document.

#include <functional>

#include "app/commands/editor.h"
#include "app/steering/source_set.h"
#include "app/tools/film_tool.h"
#include "app/tools/slices_tool.h"
#include "app/viewer/companion.h"
#include "app/viewer/display_switch.h"
#include "app/viewer/exporter.h"
#include "app/viewer/file_list.h"
#include "app/viewer/wedge_finder.h"

namespace dubsar::app {

/// One thread: that of the session.
class ViewerPlace final : public Workplace {
 public:
  /// What it asks of the window.
  struct Answers {
    std::function<Result<void>()> file_asked;  ///< another file is to be shown
    std::function<void()> sources_changed;
    std::function<bool()> may_end;
  };
  /// All outlive it.
  struct Parts {
    const ViewOptions& options;
    Presenter& presenter;
    const Clock& clock;
    ToolScene& scene;
    DisplaySwitch& displays;
    InputController& steering;
    SourceSet& sources;
    FileList& files;
    SlicesTool& slices;
    FilmTool& film;
    WedgeFinder& wedges;
    Exporter& exporter;
    CompanionTool& companion;
    Answers answers;
  };
  explicit ViewerPlace(Parts parts) : to_(std::move(parts)) {}

  Result<void> switch_display(int step) override;
  Result<void> toggle_fullscreen() override { return to_.presenter.toggle_fullscreen(); }
  Result<void> swap_eyes() override;
  void retry_sources() override { to_.sources.retry_now(); }
  void recentre_heads() override;
  bool toggle_source(std::size_t index) override;
  Result<void> open_file(const std::string& path) override;
  Result<void> open_recent(std::size_t number) override;
  Result<void> switch_file(int step) override;
  std::string next_file() const override { return to_.files.next_file(); }
  bool stop_opening() override;
  std::string present_folder() const override { return to_.files.present_folder(); }
  void say(std::string words) override { to_.scene.ask.say(std::move(words)); }
  void end() override;
  std::string today() const override;
  Result<SurfacePin> pin(const glm::dvec3& at_mm) override { return to_.scene.pin(at_mm); }
  Result<MeasureFigures> figures(const Measure& measure) override { return figures_of(*to_.scene.mesh, measure); }
  Reach reach(const glm::dvec3& home_direction) override {
    return to_.scene.reach(home_direction, to_.scene.document().home.rotation);
  }
  Reach reach_to_viewer() override { return to_.scene.reach({0, 0, 1}, to_.scene.window.view.rotation); }
  Result<SurfacePin> pin_seen() override;
  glm::dmat3 seen_axes() override { return glm::transpose(to_.scene.seen_turn(to_.scene.window.view.rotation)); }
  Result<void> write_slice(const std::string& path, std::size_t which) override;
  Result<void> picture(const std::string& path, int factor) override;
  Result<void> find_wedges(const std::string& part) override;
  bool stop_wedges() override { return to_.wedges.stop(); }
  Result<void> publish(const std::string& kind, const std::string& path) override;
  bool stop_publishing() override { return to_.exporter.stop(); }
  Result<void> play_film(std::optional<double> from_s) override;

 private:
  Parts to_;
};

}  // namespace dubsar::app
