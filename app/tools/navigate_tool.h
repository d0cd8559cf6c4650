#pragma once
// Turning, moving and zooming with a pointer or fingers: what the input controller is told of them.

#include <optional>

#include "app/steering/input_controller.h"
#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"
#include "input/window_events.h"

namespace dubsar::app {

/// The last one: it takes all that is no key.
class NavigateTool final : public Tool {
 public:
  /// What windows hear goes through `mouse`, for the source of that name; what fingers made, to `steering` itself. Both
  /// outlive it.
  NavigateTool(ToolScene& scene, InputController& steering, WindowEvents& mouse)
      : scene_(scene), steering_(steering), mouse_(mouse) {}
  bool take(InputEvent& event) override;
  /// Every event, whoever takes it: while the wheel turns at one place, or the same fingers go on, the surface under
  /// them is looked for once.
  void see(const InputEvent& event);

 private:
  void tell_depth(InputEvent& event);

  ToolScene& scene_;
  InputController& steering_;
  WindowEvents& mouse_;
  glm::dvec2 middle_{0.0};  ///< of what was taken hold of, from the window's, in its heights
  bool held_ = false;
  std::optional<InputEvent> wheeled_;  ///< the last turn of the wheel or step of fingers, with what was found there
};

}  // namespace dubsar::app
