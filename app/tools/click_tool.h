#pragma once
// Clicks on the surface, for tools that measure and note.

#include <optional>

#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"

namespace dubsar::app {

/// With a tool in the hand a press waits: when it is let go where it began it is a click, else the drag turns as ever.
class ClickTool final : public Tool {
 public:
  explicit ClickTool(ToolScene& scene) : scene_(scene) {}
  bool take(InputEvent& event) override;
  void let_go() override { press_.reset(); }

 private:
  void click(const glm::dvec2& at);

  ToolScene& scene_;
  std::optional<InputEvent> press_;
};

}  // namespace dubsar::app
