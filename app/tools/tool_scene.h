#pragma once
// What tools work on: the surface, its document and its picture, as they are now, and what they ask of the session.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "app/commands/editor.h"
#include "app/slices/slice_state.h"
#include "app/stage/picker.h"
#include "app/stage/shown_document.h"
#include "app/stage/stage.h"
#include "app/tools/surface_tools.h"
#include "core/mesh/tri_mesh.h"
#include "input/input_event.h"

namespace dubsar::app {

/// What a tool asks of its session.
struct ToolAsks {
  /// Does what a command says; what cannot be done is said over the picture. Commands in a row under the same number
  /// other than 0 are one step of the history.
  std::function<void(std::string_view command, std::uint64_t merge)> run;
  std::function<void(std::string words)> say;           ///< one line over the picture
  std::function<void(const InputEvent& event)> key;     ///< a key does what it does where no tool is held
  std::function<void(const InputEvent& event)> steers;  ///< an event goes to whoever turns, moves and zooms
};

/// How the window stands.
struct ToolWindow {
  glm::dvec2 layout{1.0};   ///< its size in pixels of the panels' layout
  double letters = 1.0;     ///< scale of letters on the surface
  glm::dvec2 pointer{0.0};  ///< where it was last, as InputEvent::at
  double aside = 0.0;       ///< how far the object stands beside the window's middle, to the right, in its heights
  std::array<PanelRect, kSlices> slices{};  ///< where those of the scan stand in the layout
  bool waits = false;                       ///< simulated time: what is read in other threads is waited for
  std::uint64_t presses = 0;                ///< of keys and buttons: tells one drag from the next
  ViewState view{};                         ///< of the last picture
};

/// One thread: that of the session, which owns what is pointed to; the editor and the mesh change with the file.
struct ToolScene {
  const TriMesh* mesh = nullptr;
  const StageOptions* options = nullptr;
  Stage* stage = nullptr;
  Editor* editor = nullptr;
  const Document* seen = nullptr;  ///< that the next picture shows: the session's own, or what a film makes of it
  std::optional<Picker> picker{};
  ToolAsks ask{};
  ToolWindow window{};

  bool has_surface() const noexcept { return !mesh->triangles.empty(); }
  const Document& document() const noexcept { return editor->document(); }
  const UiState& ui() const noexcept { return editor->ui(); }
  /// What the stage shows of a document in a view.
  Shown shown(const Document& of, const ViewState& view) const { return shown_of(of, view, *options, stage->box_mm()); }
  /// What is under this place of the window, with parts where they stand.
  std::optional<Picked> picked_at(const glm::dvec2& at) const;
  /// Where a place that is seen lies in the scan: parts stand apart.
  glm::dvec3 scan_place(const Picked& picked) const;
  /// The place of the surface that is nearest to a point of the scan; kUsage as pin_on().
  Result<SurfacePin> pin(const glm::dvec3& at_mm) const;
  /// The turn from the scan to what is seen of an object that is turned so.
  glm::dmat3 seen_turn(const glm::dquat& rotation) const {
    return glm::mat3_cast(rotation) * first_turn(stage->box_mm(), options->direction);
  }
  /// How far the surface reaches along a direction of a view (right, up, to the viewer) that is turned so.
  Workplace::Reach reach(const glm::dvec3& direction, const glm::dquat& rotation) const;
};

}  // namespace dubsar::app
