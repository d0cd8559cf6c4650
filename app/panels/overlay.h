#pragma once
// Text over the picture: the help page, what the session is doing, and a hint line. Hidden unless asked for.

#include <memory>
#include <string>
#include <vector>

#include "app/panels/help_page.h"
#include "app/viewer/stage.h"

namespace dubsar::app {

struct OverlayText {
  std::vector<HelpSection> help;  ///< shown in columns; empty: no help
  std::string notice;             ///< one line at the lower edge; empty: none
  double notice_opacity = 1.0;
  bool empty() const noexcept { return help.empty() && notice.empty(); }
  friend bool operator==(const OverlayText&, const OverlayText&) = default;
};

/// Drawn by Dear ImGui into every view at the same place, so that both eyes of every display see it on the
/// panel's plane. One at a time; the GL context that made it is current in every call and at its end.
class Overlay final : public LayerPainter {
 public:
  /// kUnavailable when Dear ImGui cannot use this context.
  static Result<std::unique_ptr<Overlay>> create();
  ~Overlay() override;
  void set(OverlayText text) { text_ = std::move(text); }
  const OverlayText& text() const noexcept { return text_; }
  Result<void> paint(ViewArray& layers, const glm::dvec2& window_mm) override;

 private:
  Overlay() = default;
  OverlayText text_;
};

}  // namespace dubsar::app
