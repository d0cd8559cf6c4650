#pragma once
// The light: dragged while L is held, or going round by itself.

#include <optional>

#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"

namespace dubsar::app {

/// While L is held a drag puts the light over the place of the pointer, as if the window were a ball; when nothing was
/// dragged the key does what it does elsewhere.
class LightTool final : public Tool {
 public:
  explicit LightTool(ToolScene& scene) : scene_(scene) {}
  bool take(InputEvent& event) override;
  void update(TimestampNs now) override { now_ = now; }
  /// The light of the next picture: that of the view, or one that goes round.
  void contribute(Shown& shown) override;
  /// It was moved at, or is held; below 0: never.
  TimestampNs moved() const noexcept { return moved_; }
  /// A sweep begins anew.
  void begin() { sweep_since_ = -1; }

 private:
  struct Held {
    InputEvent key;        ///< as it went down
    bool dragged = false;  ///< since then
  };
  ToolScene& scene_;
  std::optional<Held> held_;
  TimestampNs now_ = 0, sweep_since_ = -1, moved_ = -1;
  std::optional<LightPlace> before_;
};

}  // namespace dubsar::app
