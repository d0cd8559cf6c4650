#pragma once
// The box of cuts in a session: its handles follow the pointer.

#include <optional>

#include "app/tools/cut_box.h"
#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"

namespace dubsar::app {

/// A press on a handle takes it: its side is cut as far as the pointer takes it, all of the drag as one step.
class BoxTool final : public Tool {
 public:
  explicit BoxTool(ToolScene& scene) : scene_(scene) {}
  bool take(InputEvent& event) override;
  void let_go() override { held_.reset(); }
  /// As it is seen: the handle that is held stands out, else the one under the pointer. None: it is not shown.
  std::optional<BoxPicture> picture();
  /// A film hides it.
  void hide(bool hidden) noexcept { hidden_ = hidden; }

 private:
  /// How far the surface reaches is looked for once for each surface and each way it is turned at home.
  struct Reached {
    const TriMesh* mesh = nullptr;
    glm::dquat home{1.0, 0.0, 0.0, 0.0};
    std::array<Workplace::Reach, kBoxSides.size()> reach{};
  };
  CutBox box();
  std::optional<std::size_t> touched(const BoxPicture& picture) const;

  ToolScene& scene_;
  std::optional<Reached> reached_;
  std::optional<BoxDrag> held_;
  bool hidden_ = false;
};

}  // namespace dubsar::app
