#pragma once
// What lies over the picture: panels, the help page, what the session is doing,
// and a hint line.

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/panels/box_page.h"
#include "app/panels/gallery_page.h"
#include "app/panels/help_columns.h"
#include "app/panels/help_page.h"
#include "app/panels/legend_page.h"
#include "app/panels/light_ball.h"
#include "app/panels/window_panels.h"
#include "app/stage/stage.h"

struct ImGuiContext;

namespace dubsar::app {

struct OverlayText {
  std::vector<HelpSection> help;  ///< shown in columns; empty: no help
  std::string notice;             ///< one line at the lower edge; empty: none
  double notice_opacity = 1.0;
  std::optional<PanelState> panels{};  ///< while there is no help
  std::optional<GalleryPicture> gallery{};
  std::optional<LegendPicture> legend{};
  std::optional<LightPlace> light{};  ///< the ball on the stage, while it moves
  std::optional<BoxPicture> box{};    ///< of cuts, to be dragged
  bool empty() const noexcept {
    return help.empty() && notice.empty() && !panels && !gallery && !legend && !light && !box;
  }
  friend bool operator==(const OverlayText&, const OverlayText&) = default;
};

/// Drawn by Dear ImGui into every view at the same place, so that both eyes of
/// every display see it on the panel's plane. The GL context that made it is
/// current in every call and at its end; each has its own state of Dear ImGui.
/// One thread for all.
class Overlay final : public LayerPainter {
 public:
  /// `keys` outlives it. kUnavailable when Dear ImGui cannot use this context.
  static Result<std::unique_ptr<Overlay>> create(const KeyTable& keys);
  ~Overlay() override;
  /// Letters that were not needed yet are made with the next picture.
  void set(OverlayText text) { text_ = std::move(text); }
  const OverlayText& text() const noexcept { return text_; }
  Result<void> paint(ViewArray& layers, const glm::dvec2& window_mm) override;

  /// Pixels of the layout for views of this size on a window of this shape.
  /// `scale` is how many pixels of a view one of the layout has; 0: what suits the height, at most 900 pixels of
  /// layout.
  static glm::dvec2 layout(int view_height, const glm::dvec2& window_mm, double scale = 0.0);
  /// For paint(); as of layout().
  void set_scale(double scale) noexcept { wanted_scale_ = scale; }

  /// An event, before the object sees it: true when a panel takes it. Keys are taken while something is typed.
  /// `layout` as above.
  bool take(const InputEvent& event, const glm::dvec2& layout);
  /// What was asked for since the last call.
  std::vector<std::string> take_commands();

 private:
  class Turn;
  Overlay(const KeyTable& keys, ImGuiContext* state) : keys_(keys), state_(state) {}
  bool take_key(const InputEvent& event, const glm::dvec2& layout);
  bool scroll_help(const InputEvent& event);
  void frame(const glm::dvec2& layout, const glm::dvec2& scale);
  void draw_in_panel_letters(const std::function<void()>& draw) const;
  void draw_all(float width, float height);
  void take_letters();

  const KeyTable& keys_;
  ImGuiContext* state_;
  OverlayText text_;
  std::vector<std::string> commands_;
  glm::dvec2 scale_{1.0, 1.0};
  double wanted_scale_ = 0.0;
  HelpScroll help_{};
  float px_per_mm_ = 3.0f;
  std::array<bool, 3> held_{};      ///< buttons that went down on a panel
  bool object_held_ = false;        ///< one went down beside them
  std::size_t notes_answered_ = 0;  ///< of Pointing::notes
  bool all_letters_ = false;        ///< those of Hebrew and Arabic are there
};

}  // namespace dubsar::app
